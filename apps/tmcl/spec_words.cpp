#include "apps/tmcl/spec_words.hpp"

namespace opentmcl::app {

std::string letters_of(Access access) {
  std::string letters;
  if (allows(access, Access::r)) letters += 'R';
  if (allows(access, Access::w)) letters += 'W';
  if (allows(access, Access::e)) letters += 'E';
  if (allows(access, Access::a)) letters += 'A';
  return letters;
}

const char* name_of(Field field) {
  switch (field) {
    case Field::none:
      return "none";
    case Field::type:
      return "type";
    case Field::motor:
      return "motor";
    case Field::value:
      return "value";
  }
  return "unknown";
}

const char* name_of(Where where) {
  switch (where) {
    case Where::direct_and_program:
      return "direct and program";
    case Where::program_only:
      return "program";
    case Where::direct_only:
      return "direct";
  }
  return "unknown";
}

const char* name_of(InterruptSetting setting) {
  switch (setting) {
    case InterruptSetting::none:
      return "none";
    case InterruptSetting::period:
      return "period";
    case InterruptSetting::edge:
      return "edge";
  }
  return "unknown";
}

}  // namespace opentmcl::app
