// The figures of docs/physics/README.md as CSV files: physics_figures DIRECTORY

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <memory>
#include <numbers>
#include <string>

#include "twin/physics/motor_shaft.hpp"

namespace {

using namespace opentmcl::twin;

constexpr double turns_per_second_and_rpm = MotorData::pole_pairs / 60;
constexpr double degrees_per_turn = 360;

/// A motor at its rated current on 24 V with a field that is moved by hand, always integrated.
class Bench {
 public:
  explicit Bench(const MotorData& motor) : shaft_(motor, std::make_shared<TorqueTables>()) {
    shaft_.set_always_free(true);
    set_inertia(1e-5);
    field_.energised = true;
    field_.amplitude = motor.rated_amplitude();
  }

  void set_inertia(double inertia) {
    load_.inertia = inertia;
    shaft_.set_load(load_);
  }
  void set_torque(double torque) {
    load_.torque = torque;
    shaft_.set_load(load_);
  }
  double torque() const { return load_.torque; }
  void set_friction(double torque) {
    load_.coulomb_friction = torque;
    shaft_.set_load(load_);
  }

  void run(Tick span) {
    shaft_.advance_to(shaft_.now() + span, field_);
    field_.angle = field_.angle_after(seconds_of(span));
    field_.velocity = field_.velocity_after(seconds_of(span));
  }

  void accelerate_to(double rpm, int milliseconds) {
    field_.acceleration = (rpm * turns_per_second_and_rpm - field_.velocity) / (milliseconds * 1e-3);
    for (int i = 0; i < milliseconds; ++i) run(ticks_per_millisecond);
    field_.acceleration = 0;
    field_.velocity = rpm * turns_per_second_and_rpm;
  }

  void set_acceleration(double turns_per_second_squared) { field_.acceleration = turns_per_second_squared; }
  void stop() { field_.velocity = field_.acceleration = 0; }
  void step_field(double turns) { field_.angle += turns; }

  double seconds() const { return seconds_of(shaft_.now()); }
  double lead() const { return field_.angle - shaft_.state().angle; }
  const Field& field() const { return field_; }
  const MotorShaft& shaft() const { return shaft_; }

 private:
  MotorShaft shaft_;
  Load load_;
  Field field_;
};

/// A table of numbers, written row by row.
class Table {
 public:
  Table(const std::filesystem::path& directory, const std::string& name, const char* head)
      : file_(directory / (name + ".csv")) {
    file_.exceptions(std::ios::failbit | std::ios::badbit);
    file_ << head << '\n';
  }

  template <typename... Numbers>
  void row(double first, Numbers... rest) {
    file_ << first;
    ((file_ << ',' << rest), ...);
    file_ << '\n';
  }

 private:
  std::ofstream file_;
};

/// Torque at the shaft that each motor carries on at a speed: integrated, the load raised until the rotor is a turn
/// behind, and by the averaged model less friction.
void pull_out_torque(const std::filesystem::path& directory) {
  for (const MotorData& motor : motors()) {
    Table table(directory, "pull_out_torque_" + std::string(motor.name), "rpm,integrated_N_m,averaged_N_m");
    TorqueTables tables;
    const auto averaged = tables.table(motor, TorqueTables::key(24, motor.rated_amplitude(), 25));
    for (int rpm = 50; rpm <= 1500; rpm += 50) {
      Bench bench(motor);
      // As much inertia as the rotor's own.
      bench.set_inertia(motor.rotor_inertia);
      bench.accelerate_to(rpm, 1000);
      for (int i = 0; i < 100; ++i) bench.run(ticks_per_millisecond);
      // Full torque in two seconds.
      while (std::fabs(bench.lead()) < 1 && bench.torque() < motor.holding_torque) {
        bench.set_torque(bench.torque() + motor.holding_torque / 2000);
        bench.run(ticks_per_millisecond);
      }
      const double friction = motor.coulomb_friction + motor.viscous_friction * rpm / 60 * 2 * std::numbers::pi;
      table.row(rpm, bench.torque(), averaged->pull_out_torque(rpm * turns_per_second_and_rpm) - friction);
    }
  }
}

/// The rotor after one full step.
void step_response(const std::filesystem::path& directory) {
  Table table(directory, "step_response", "ms,field_full_steps,rotor_full_steps");
  Bench bench(motors().front());
  for (int i = 0; i < 10; ++i) bench.run(ticks_per_millisecond);
  const double begin = bench.seconds();
  bench.step_field(0.25);
  for (int i = 0; i < 400; ++i) {
    bench.run(100 * ticks_per_microsecond);
    table.row((bench.seconds() - begin) * 1e3, 4 * bench.field().angle, 4 * bench.shaft().state().angle);
  }
}

/// Root mean square of the speed's ripple over the mean.
double ripple(double full_steps_per_second, bool in_full_steps) {
  Bench bench(motors().front());
  const double velocity = full_steps_per_second / 4;
  if (!in_full_steps) bench.accelerate_to(full_steps_per_second / 200 * 60, 500);
  constexpr Tick look = 20 * ticks_per_microsecond;
  const double begin = bench.seconds();
  double next_step = begin;
  double squares = 0;
  int count = 0;
  while (bench.seconds() < begin + 1.5) {
    if (in_full_steps && bench.seconds() >= next_step) {
      bench.step_field(0.25);
      next_step += 1 / full_steps_per_second;
    }
    bench.run(look);
    if (bench.seconds() > begin + 0.5) {
      const double deviation = bench.shaft().state().velocity - velocity;
      squares += deviation * deviation;
      ++count;
    }
  }
  return std::sqrt(squares / count) / velocity;
}

void resonance(const std::filesystem::path& directory) {
  Table table(directory, "resonance", "full_steps_per_second,ripple_full_step,ripple_256_microsteps");
  for (double speed = 20; speed < 1000; speed *= 1.05) table.row(speed, ripple(speed, true), ripple(speed, false));
}

/// The motor of 51 mm at 800 rpm: the same load on and on, and a swing that grows until steps are lost.
void mid_band_instability(const std::filesystem::path& directory) {
  Table table(directory, "mid_band_instability", "s,lead_at_half_load_deg,lead_without_load_deg");
  const MotorData& motor = *find_motor("QSH5718-51-28-101");
  Bench loaded(motor);
  Bench idle(motor);
  for (Bench* bench : {&loaded, &idle}) bench->accelerate_to(800, 500);
  const auto lead = [](const Bench& bench) { return bench.lead() * degrees_per_turn; };
  while (loaded.seconds() < 2.5) {
    // From 0.5 s to 1.5 s the load rises to what the averaged model says is half of the pull-out torque.
    loaded.set_torque(0.37 * std::clamp(loaded.seconds() - 0.5, 0.0, 1.0));
    loaded.run(ticks_per_millisecond);
    idle.run(ticks_per_millisecond);
    if (std::fabs(loaded.lead()) > 1) break;
    table.row(loaded.seconds(), lead(loaded), lead(idle));
  }
}

void stall_guard(const std::filesystem::path& directory) {
  Table table(directory, "stall_guard", "load_percent,at_120_rpm,at_290_rpm,at_500_rpm");
  const MotorData& motor = motors().front();
  const auto measured = [&](double rpm, double share) {
    Bench bench(motor);
    bench.accelerate_to(rpm, 500);
    double sum = 0;
    constexpr int rise = 500;
    constexpr int samples = 200;
    for (int i = 0; i < rise + samples; ++i) {
      // A brake: what stalls stands, instead of being torn away by its load.
      bench.set_friction(share * motor.holding_torque * std::min(1.0, static_cast<double>(i) / rise));
      bench.run(ticks_per_millisecond);
      if (i >= rise) sum += std::clamp(bench.shaft().stall_guard_measurement(), 0, 1023);
    }
    return sum / samples;
  };
  for (int percent = 0; percent <= 110; percent += 5) {
    const double share = percent / 100.0;
    table.row(percent, measured(120, share), measured(290, share), measured(500, share));
  }
}

/// A brake that is too strong for a moment: the rotor slips, is caught again when the field has become slow, and lacks
/// whole electrical turns.
void stall(const std::filesystem::path& directory) {
  Table table(directory, "stall", "s,field_rpm,rotor_rpm,lost_full_steps,stall_guard");
  Bench bench(motors().front());
  const auto run_until = [&](double end) {
    while (bench.seconds() < end) {
      bench.run(ticks_per_millisecond);
      table.row(bench.seconds(), bench.field().velocity / turns_per_second_and_rpm,
                bench.shaft().state().velocity / turns_per_second_and_rpm, 4 * bench.lead(),
                std::clamp(bench.shaft().stall_guard_measurement(), 0, 1023));
    }
  };
  bench.set_friction(0.1);
  bench.accelerate_to(290, 300);
  run_until(0.4);
  bench.set_friction(0.7);
  run_until(0.45);
  bench.set_friction(0.1);
  run_until(0.55);
  bench.set_acceleration(-290 * turns_per_second_and_rpm / 0.2);
  run_until(0.75);
  bench.stop();
  run_until(0.8);
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fputs("usage: physics_figures DIRECTORY\n", stderr);
    return 64;
  }
  try {
    const std::filesystem::path directory = argv[1];
    std::filesystem::create_directories(directory);
    for (const auto figure : {pull_out_torque, step_response, resonance, mid_band_instability, stall_guard, stall}) {
      figure(directory);
    }
  } catch (const std::exception& error) {
    std::fprintf(stderr, "physics_figures: %s\n", error.what());
    return 74;
  }
  return 0;
}
