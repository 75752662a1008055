#include "tests/programs/program_run.hpp"

#include <gtest/gtest.h>

#include <cstdlib>

#include "firmware/hal/pins.hpp"
#include "firmware/module/module.hpp"
#include "firmware/spec/io_ports.hpp"

namespace opentmcl::tests {

namespace {

/// Programs that do not say how long they run have to end within this time.
constexpr Microseconds longest_run = 60 * 1'000 * one_millisecond;

/// What a host asks for to know a quantity.
struct Reading {
  const char* name;
  Opcode opcode;
  std::uint8_t type;  ///< where the quantity has no number of its own
  std::uint8_t motor;
};

constexpr std::uint8_t in_type = 0;
constexpr std::uint8_t accumulator = 2;  // of command 135
constexpr std::uint8_t x_register = 3;

constexpr Reading readings[] = {
    {"variable", Opcode::ggp, in_type, static_cast<std::uint8_t>(Bank::user_variables)},
    {"accumulator", Opcode::get_application_status, accumulator, 0},
    {"x", Opcode::get_application_status, x_register, 0},
    {"position", Opcode::gap, static_cast<std::uint8_t>(AxisParameter::actual_position), 0},
    {"target", Opcode::gap, static_cast<std::uint8_t>(AxisParameter::target_position), 0},
    {"speed", Opcode::gap, static_cast<std::uint8_t>(AxisParameter::actual_speed), 0},
    {"target speed", Opcode::gap, static_cast<std::uint8_t>(AxisParameter::target_speed), 0},
    {"axis parameter", Opcode::gap, in_type, 0},
    {"global parameter", Opcode::ggp, in_type, 0},
    {"coordinate", Opcode::gco, in_type, 0},
    {"output", Opcode::gio, in_type, static_cast<std::uint8_t>(IoBank::digital_outputs)},
    {"program", Opcode::ggp, static_cast<std::uint8_t>(GlobalParameter::application_status), 0},
    {"program counter", Opcode::ggp, static_cast<std::uint8_t>(GlobalParameter::program_counter), 0},
};

void set_level(twin::World& world, unsigned bit, bool level) {
  const std::uint32_t mask = 1U << bit;
  world.set_inputs(level ? world.inputs() | mask : world.inputs() & ~mask);
}

}  // namespace

ProgramRun::ProgramRun(const TestProgram& program, const ModuleDescription& module)
    : program_(program), bench_(module) {}

void ProgramRun::fail(int line, const std::string& message) const {
  ADD_FAILURE_AT(program_.path.c_str(), line) << message;
}

Reply ProgramRun::command(Opcode opcode, std::uint8_t type, std::uint8_t motor, std::int32_t value) {
  const Request request{1, {static_cast<std::uint8_t>(opcode), type, motor, value}};
  Datagram reply;
  const auto handling = bench_.module.module().handle(encode(request), hal::PortKind::usb, bench_.module.now(), reply);
  EXPECT_EQ(handling, Module::Handling::answered) << "opcode " << static_cast<int>(opcode);
  return decode_reply(reply);
}

void ProgramRun::download() {
  ASSERT_EQ(bench_.command(Opcode::enter_download_mode).status, Status::ok);
  for (const Command& instruction : program_.commands) {
    ASSERT_EQ(bench_.command(instruction).status, Status::command_loaded);
  }
  ASSERT_EQ(bench_.command(Opcode::exit_download_mode).status, Status::ok);
  bench_.wait(30 * one_millisecond);  // until the last page is written
}

bool ProgramRun::is_running() {
  return command(Opcode::ggp, static_cast<std::uint8_t>(GlobalParameter::application_status)).value != 0;
}

void ProgramRun::apply(const Setting& setting) {
  twin::World& world = bench_.module.world();
  const std::string& name = setting.quantity.name;
  const std::uint8_t number = setting.quantity.number.value_or(0);
  const bool level = setting.value != 0;
  if (name == "input") {
    set_level(world, number, level);
  } else if (name == "home switch") {
    set_level(world, static_cast<unsigned>(hal::InputPin::home_switch), level);
  } else if (name == "left switch") {
    world.set_left_switch(level);
  } else if (name == "right switch") {
    world.set_right_switch(level);
  } else if (name == "analog input") {
    world.set_analog_input(number, setting.value);
  } else if (name == "variable") {
    command(Opcode::sgp, number, static_cast<std::uint8_t>(Bank::user_variables), setting.value);
  } else if (name == "program") {
    command(level ? Opcode::run_application : Opcode::stop_application);
  } else if (name == "start") {
    constexpr std::uint8_t from_address = 1;
    EXPECT_EQ(command(Opcode::run_application, from_address, 0, setting.value).status, Status::ok);
  } else {
    fail(setting.line, "nobody can set \"" + name + "\"");
  }
  bench_.module.wake();
}

std::int32_t ProgramRun::read(const Quantity& quantity) {
  for (const Reading& reading : readings) {
    if (quantity.name != reading.name) continue;
    const Reply reply = command(reading.opcode, quantity.number.value_or(reading.type), reading.motor);
    EXPECT_EQ(reply.status, Status::ok) << quantity.name;
    return reply.value;
  }
  ADD_FAILURE() << "nobody can read \"" << quantity.name << '"';
  return 0;
}

bool ProgramRun::holds(const Expectation& expectation) {
  const std::int64_t difference = std::int64_t{read(expectation.quantity)} - expectation.value;
  return std::llabs(difference) <= expectation.tolerance;
}

void ProgramRun::check(const Expectation& expectation) {
  if (holds(expectation)) return;
  fail(expectation.line, "expected" + expectation.text + ", found " + std::to_string(read(expectation.quantity)) +
                             " on the " + bench_.module.description().name);
}

void ProgramRun::execute() {
  using When = Expectation::When;
  download();
  command(Opcode::reset_application);
  command(Opcode::run_application);
  bench_.module.wake();
  const Microseconds start = bench_.module.now();

  auto setting = program_.script.settings.begin();
  std::vector<const Expectation*> waiting;
  for (const Expectation& expectation : program_.script.expectations) {
    if (expectation.when != When::at_end) waiting.push_back(&expectation);
  }
  const Microseconds end = program_.script.run_time.value_or(longest_run);
  for (Microseconds time = 0; time <= end; time += one_millisecond) {
    bench_.module.advance_to(start + time);
    for (; setting != program_.script.settings.end() && setting->time <= time; ++setting) apply(*setting);
    std::erase_if(waiting, [&](const Expectation* expectation) {
      if (expectation->when == When::within) return holds(*expectation);
      if (expectation->time > time) return false;
      check(*expectation);
      return true;
    });
    const bool is_over = setting == program_.script.settings.end() && waiting.empty() && !is_running();
    if (is_over && !program_.script.run_time) break;
  }
  if (!program_.script.run_time && is_running()) fail(1, "the program did not end");
  if (setting != program_.script.settings.end()) fail(setting->line, "this is after the end of the run");
  for (const Expectation* expectation : waiting) check(*expectation);
  for (const Expectation& expectation : program_.script.expectations) {
    if (expectation.when == When::at_end) check(expectation);
  }
}

}  // namespace opentmcl::tests
