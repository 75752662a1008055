#include "tests/motor_loop/motor_bench.hpp"

#include <cstdlib>

namespace opentmcl::tests {

double holding_torque() {
  return twin::motors().front().holding_torque;
}

VirtualModule::Options free_shaft() {
  VirtualModule::Options options;
  // As much as the rotor's own: a coupling and a pulley.
  options.machine = twin::RotaryAxisDimensions{.inertia = 1e-5};
  options.motor = twin::motors().front();
  return options;
}

std::string name_of_module(const testing::TestParamInfo<ModuleId>& tested) {
  return tested.param == ModuleId::pd1161 ? "pd1161" : "tmcm1110";
}

MotorBench::MotorBench(const ModuleDescription& description, const VirtualModule::Options& options,
                       twin::TraceObserver* observer)
    : Bench(description, hal::PortKind::usb, observer, options) {
  set(AxisParameter::pulse_divisor, 0);
  set(AxisParameter::maximum_current, 255);
}

void MotorBench::set_load_torque(double torque) {
  twin::Load load = world().load();
  load.torque = torque;
  module.world().set_load(load);
}

void MotorBench::set_brake(double torque) {
  twin::Load load = world().load();
  load.coulomb_friction = torque;
  module.world().set_load(load);
}

void MotorBench::jam() {
  twin::Load load = world().load();
  load.jammed = true;
  module.world().set_load(load);
}

void MotorBench::rotate(double rpm) {
  const std::int32_t velocity = velocity_of(std::abs(rpm));
  command(rpm < 0 ? Opcode::rol : Opcode::ror, 0, 0, velocity);
  for (int looks = 0; std::abs(speed()) != velocity; ++looks) {
    if (looks == 1'000) {
      ADD_FAILURE() << "does not come to " << rpm << " rpm";
      return;
    }
    wait_ms(1);
  }
}

std::int32_t MotorBench::position_at_once() const {
  using tmc429::ActualPosition;
  const std::uint32_t datagram = tmc429::read_datagram<ActualPosition>();
  return ActualPosition::Value::in(tmc429::word_in<ActualPosition>(world().tmc429().read(datagram)));
}

double MotorBench::full_steps_lost() {
  const double way = position_at_once() - static_cast<double>(world().rotor_angle());
  return way / full_step;
}

}  // namespace opentmcl::tests
