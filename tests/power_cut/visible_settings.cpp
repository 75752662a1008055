#include "tests/power_cut/visible_settings.hpp"

#include <gtest/gtest.h>

#include <algorithm>

namespace opentmcl::tests {

namespace {

constexpr unsigned stored_variables = 56;
constexpr unsigned coordinates = 21;

/// Axis parameters that report something: positions, speeds, switches, load, flags, encoder.
constexpr std::uint8_t live_axis_parameters[] = {0, 1, 2, 3, 8, 9, 10, 11, 135, 180, 196, 197, 206, 207, 208, 209, 215};

/// What to ask a module of this kind: all numbers that a module with an erased EEPROM answers.
std::vector<Command> find_questions(const ModuleDescription& description) {
  RecordedModule module(description, erased_image());
  std::vector<Command> questions;
  const auto add_if_answered = [&](const Command& question) {
    const auto reply = module.exchange(question);
    if (reply && decode_reply(*reply).status == Status::ok) questions.push_back(question);
  };
  for (unsigned number = 0; number < 256; ++number) {
    const bool is_live = std::find(std::begin(live_axis_parameters), std::end(live_axis_parameters), number) !=
                         std::end(live_axis_parameters);
    if (!is_live) add_if_answered(command(Opcode::gap, number));
  }
  for (unsigned number = 64; number < 128; ++number) add_if_answered(command(Opcode::ggp, number));
  constexpr unsigned bank = 2;
  // One more of the variables than can be stored.
  for (unsigned number = 0; number <= stored_variables; ++number)
    questions.push_back(command(Opcode::ggp, number, bank));
  for (unsigned number = 0; number < coordinates; ++number) questions.push_back(command(Opcode::gco, number));
  // And once more after they were copied from the EEPROM.
  for (unsigned number = 0; number < stored_variables; ++number) {
    questions.push_back(command(Opcode::rsgp, number, bank));
    questions.push_back(command(Opcode::ggp, number, bank));
  }
  questions.push_back(command(Opcode::gco, 0, 255));
  for (unsigned number = 0; number < coordinates; ++number) questions.push_back(command(Opcode::gco, number));
  return questions;
}

const std::vector<Command>& questions_for(const ModuleDescription& description) {
  static const std::vector<Command> questions[] = {find_questions(tmcm1110), find_questions(pd1161)};
  return questions[static_cast<std::size_t>(description.id)];
}

}  // namespace

std::string name_of(const VisibleSetting& setting) {
  const Command& question = setting.question;
  return "opcode " + std::to_string(question.opcode) + ", type " + std::to_string(question.type) + ", motor or bank " +
         std::to_string(question.motor);
}

std::vector<VisibleSetting> visible_settings(RecordedModule& module) {
  const std::vector<Command>& questions = questions_for(module.module().description());
  std::vector<VisibleSetting> settings;
  settings.reserve(questions.size());
  for (const Command& question : questions) settings.push_back({question, module.execute(question)});
  return settings;
}

std::vector<VisibleSetting> visible_settings(const ModuleDescription& description, const Image& eeprom) {
  RecordedModule module(description, eeprom);
  return visible_settings(module);
}

bool are_old_or_new(const std::vector<VisibleSetting>& settings, const std::vector<VisibleSetting>& before,
                    const std::vector<VisibleSetting>& after) {
  if (settings.size() != before.size() || settings.size() != after.size()) {
    ADD_FAILURE() << "lists of different modules";
    return false;
  }
  for (std::size_t i = 0; i < settings.size(); ++i) {
    if (settings[i] == before[i] || settings[i] == after[i]) continue;
    ADD_FAILURE() << name_of(settings[i]) << " is " << settings[i].value << ", was " << before[i].value
                  << " and was to be " << after[i].value;
    return false;
  }
  return true;
}

std::vector<std::array<std::uint8_t, 7>> visible_program(RecordedModule& module, unsigned count) {
  std::vector<std::array<std::uint8_t, 7>> program;
  for (unsigned address = 0; address < count; ++address) {
    const auto reply = module.exchange(command(Opcode::read_program_memory, 0, 0, static_cast<std::int32_t>(address)));
    if (!reply) return {};
    std::array<std::uint8_t, 7> instruction;
    std::copy_n(reply->bytes + 1, instruction.size(), instruction.begin());
    program.push_back(instruction);
  }
  return program;
}

bool is_program_running(RecordedModule& module) {
  constexpr unsigned application_status = 128;
  return module.execute(command(Opcode::ggp, application_status)) == 1;
}

}  // namespace opentmcl::tests
