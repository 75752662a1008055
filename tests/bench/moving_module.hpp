// What a whole virtual module is measured with: firmware, chips, motor and machine, and a host at its port.
#pragma once

#include <cstdint>
#include <string_view>

#include "boards/twin/virtual_module.hpp"
#include "firmware/spec/axis_parameters.hpp"
#include "tests/bench/direct_mode_boards.hpp"
#include "tests/bench/program_loop.hpp"

namespace opentmcl::bench {

/// A PD-1161 with its real motor on a long stage, pulled at with 0.03 N m.
class MovingModule {
 public:
  MovingModule() : module_(pd1161, {{&port_, hal::PortKind::usb}}, options()) { pass(one_millisecond); }

  const VirtualModule& module() const { return module_; }

  void pass(Microseconds time) { module_.advance_to(module_.now() + time); }

  /// @return the value of the reply
  std::int32_t execute(const Command& command) {
    port_.send(encode(Request{1, command}));
    module_.wake();
    module_.advance_to(module_.now());
    return decode_reply(port_.reply()).value;
  }
  void set(AxisParameter parameter, std::int32_t value) {
    execute(instruction(Opcode::sap, static_cast<std::uint8_t>(parameter), 0, value));
  }
  std::int32_t get(AxisParameter parameter) {
    return execute(instruction(Opcode::gap, static_cast<std::uint8_t>(parameter)));
  }

 private:
  static VirtualModule::Options options() {
    twin::LinearStageDimensions stage;
    stage.travel = 2'000'000'000;  // µm
    VirtualModule::Options options;
    options.machine = stage;
    options.motor = twin::motors().front();
    options.load = 100;  // N
    return options;
  }

  MemoryPort port_;
  VirtualModule module_;
};

/// What a module does while it is measured.
struct Situation {
  std::string_view name;
  Microseconds stretch;           ///< simulated time of a repetition
  void (*begin)(MovingModule&);   ///< once
  void (*repeat)(MovingModule&);  ///< lets a stretch pass
  bool (*is_met)(const MovingModule&);
};

namespace situations {

inline constexpr std::int32_t velocity = 1000;  // internal units: 36 rpm
inline constexpr Microseconds short_stretch = 10 * one_millisecond;
inline constexpr Microseconds long_stretch = 1000 * one_millisecond;

inline bool is_locked(const MovingModule& bench) {
  return bench.module().world().motor()->regime() == twin::Regime::locked;
}

inline void begin_to_turn(MovingModule& bench) {
  bench.execute(instruction(Opcode::ror, 0, 0, velocity));
  bench.pass(2 * long_stretch);
}

inline void observe(MovingModule& bench) {
  bench.pass(short_stretch);
  bench.get(AxisParameter::actual_position);
}

/// MVP, WAIT POS, MVP, WAIT POS, JA.
inline void begin_program(MovingModule& bench) {
  constexpr std::uint8_t relative = 1;
  constexpr std::uint8_t position = 1;
  constexpr Command program[] = {
      instruction(Opcode::mvp, relative, 0, 512'000),
      instruction(Opcode::wait, position, 0, 0),
      instruction(Opcode::mvp, relative, 0, -512'000),
      instruction(Opcode::wait, position, 0, 0),
      instruction(Opcode::ja),
  };
  constexpr Microseconds time_to_write = 20 * one_millisecond;
  bench.execute(instruction(Opcode::enter_download_mode));
  for (const Command& command : program) {
    bench.execute(command);
    bench.pass(time_to_write);
  }
  bench.execute(instruction(Opcode::exit_download_mode));
  bench.pass(time_to_write);
  bench.execute(instruction(Opcode::run_application, 1));
  bench.pass(2 * long_stretch);
}

inline void begin_full_steps(MovingModule& bench) {
  bench.set(AxisParameter::microstep_resolution, 0);
  bench.set(AxisParameter::pulse_divisor, 10);
  begin_to_turn(bench);
}

inline void begin_to_stand(MovingModule& bench) {
  bench.execute(instruction(Opcode::mvp, 1, 0, 51'200));
  bench.pass(20 * long_stretch);
}

}  // namespace situations

inline constexpr Situation measured_situations[] = {
    {.name = "locked_and_observed",  // turning evenly, its position read by a host
     .stretch = situations::short_stretch,
     .begin = situations::begin_to_turn,
     .repeat = situations::observe,
     .is_met = situations::is_locked},
    {.name = "program_with_wait",  // to and fro
     .stretch = situations::long_stretch,
     .begin = situations::begin_program,
     .repeat = [](MovingModule& bench) { bench.pass(situations::long_stretch); },
     .is_met = [](const MovingModule& bench) { return bench.module().world().rotor_angle() != 0; }},
    {.name = "free_in_full_steps",  // the motor's currents are integrated
     .stretch = situations::short_stretch,
     .begin = situations::begin_full_steps,
     .repeat = [](MovingModule& bench) { bench.pass(situations::short_stretch); },
     .is_met = [](const MovingModule& bench) { return !situations::is_locked(bench); }},
    {.name = "standing_still",
     .stretch = situations::long_stretch,
     .begin = situations::begin_to_stand,
     .repeat = [](MovingModule& bench) { bench.pass(situations::long_stretch); },
     .is_met = [](const MovingModule& bench) { return bench.module().world().tmc429().at_target(); }},
};

}  // namespace opentmcl::bench
