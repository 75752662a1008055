#include "firmware/tmcl/program_machine.hpp"

namespace opentmcl {

void ProgramMachine::run_from(std::uint16_t address) {
  close_routines();
  jump(address);
  run();
}

void ProgramMachine::close_routines() {
  depth_ = 0;
  waiting_ = false;
  in_interrupt_ = false;
  interrupts.forget_events();
}

void ProgramMachine::reset() {
  stop();
  registers = Registers{};
  program_counter_ = 0;
  close_routines();
}

void ProgramMachine::call(std::uint16_t address) {
  if (depth_ == stack_size) return;
  stack_[depth_++] = program_counter_;
  jump(address);
}

void ProgramMachine::return_from_subroutine() {
  if (depth_ == 0) return;
  jump(stack_[--depth_]);
}

void ProgramMachine::enter_interrupt(std::uint16_t vector) {
  interrupted_ = {registers, program_counter_, waiting_, waits_for_, wait_deadline_};
  in_interrupt_ = true;
  waiting_ = false;
  program_counter_ = vector;
}

void ProgramMachine::return_from_interrupt() {
  if (!in_interrupt_) return;
  in_interrupt_ = false;
  registers = interrupted_.registers;
  waiting_ = interrupted_.waiting;
  waits_for_ = interrupted_.waits_for;
  wait_deadline_ = interrupted_.wait_deadline;
  jump(interrupted_.program_counter);
}

void ProgramMachine::begin_wait(Microseconds now, Microseconds limit, WaitsFor event) {
  if (waiting_) return;
  waiting_ = true;
  waits_for_ = event;
  wait_deadline_ = limit == never ? never : now + limit;
}

}  // namespace opentmcl
