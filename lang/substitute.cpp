#include "lang/substitute.hpp"

namespace opentmcl::lang {

const char* substitute_for(Opcode opcode) {
  switch (opcode) {
    case Opcode::call:
      return "use JC and CSUB: jump over the CSUB when the condition does not hold";
    case Opcode::djnz:
      return "use GGP, CALC SUB, 1, AGP and JC NZ";
    case Opcode::rst:
      return "use JA, with as many RSUB executed as CSUB";
    case Opcode::calcvv:
    case Opcode::calcva:
    case Opcode::calcav:
    case Opcode::calcvx:
    case Opcode::calcxv:
      return "use GGP and AGP for the variables, and CALCX";
    case Opcode::calcv:
      return "use GGP, CALC and AGP";
    case Opcode::mvpa:
      return "use AAP to set the target position, axis parameter 0";
    case Opcode::rora:
    case Opcode::rola:
      return "use AAP to set the target speed, axis parameter 2";
    default:
      return nullptr;
  }
}

}  // namespace opentmcl::lang
