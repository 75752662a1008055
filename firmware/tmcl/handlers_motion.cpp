#include "firmware/motion/wrapping.hpp"
#include "firmware/tmcl/handlers.hpp"

namespace opentmcl {

namespace {

/// Type byte of RFS.
enum class SearchAction : std::uint8_t { start = 0, stop = 1, status = 2 };

enum class MoveMode : std::uint8_t { absolute = 0, relative = 1, coordinate = 2 };

constexpr std::int32_t maximum_velocity = tmc429::TargetVelocity::Value::maximum;

}  // namespace

Outcome Handlers::rotate(Executor& executor, const Command& command, std::int32_t velocity) {
  if (velocity != 0 && parts(executor).axis.is_locked()) return with_status(Status::command_not_available, command);
  parts(executor).reference_search.yield_motor();
  parts(executor).axis.rotate(velocity);
  return done(command);
}

Outcome Handlers::rotate_right(Executor& executor, const Command& command) {
  return rotate(executor, command, command.value);
}

Outcome Handlers::rotate_left(Executor& executor, const Command& command) {
  return rotate(executor, command, -command.value);
}

Outcome Handlers::motor_stop(Executor& executor, const Command& command) {
  return rotate(executor, command, 0);
}

Outcome Handlers::rotate_right_accumulator(Executor& executor, const Command& command) {
  const std::int32_t velocity = registers(executor).accumulator;
  if (velocity < -maximum_velocity || velocity > maximum_velocity) return with_status(Status::invalid_value, command);
  return rotate(executor, command, velocity);
}

Outcome Handlers::rotate_left_accumulator(Executor& executor, const Command& command) {
  const std::int32_t velocity = registers(executor).accumulator;
  if (velocity < -maximum_velocity || velocity > maximum_velocity) return with_status(Status::invalid_value, command);
  return rotate(executor, command, -velocity);
}

/// MVP REL answers with the new target, as hosts expect that compute with it (docs/decisions/0010-replies.md).
Outcome Handlers::move(Executor& executor, const Command& command, std::int32_t operand) {
  Axis& axis = parts(executor).axis;
  Outcome outcome = done(command);
  std::int32_t target = operand;
  switch (static_cast<MoveMode>(command.type)) {
    case MoveMode::absolute:
      break;
    case MoveMode::relative:
      target = wrapping_sum(axis.position(), operand);
      outcome.value = target;
      break;
    case MoveMode::coordinate:
      if (operand < 0 || operand >= static_cast<std::int32_t>(coordinate_count)) {
        return with_status(Status::invalid_value, command);
      }
      target = parts(executor).global_parameters.coordinate(static_cast<std::uint8_t>(operand));
      break;
  }
  // The motor byte of a move to a coordinate is a group of motors; with one axis every group is that axis (E-51).
  const bool is_motor = command.motor < parts(executor).description.axis_count;
  if (!is_motor && static_cast<MoveMode>(command.type) != MoveMode::coordinate) {
    return with_status(Status::invalid_value, command);
  }
  if (axis.is_locked()) return with_status(Status::command_not_available, command);
  parts(executor).reference_search.yield_motor();
  axis.move_to(target);
  if (executor.source_ == Executor::Source::direct) executor.reported_move_ = true;
  return outcome;
}

Outcome Handlers::move_to_position(Executor& executor, const Command& command) {
  return move(executor, command, command.value);
}

Outcome Handlers::move_to_accumulator(Executor& executor, const Command& command) {
  return move(executor, command, registers(executor).accumulator);
}

Outcome Handlers::reference_search(Executor& executor, const Command& command) {
  ReferenceSearch& search = parts(executor).reference_search;
  switch (static_cast<SearchAction>(command.type)) {
    case SearchAction::start:
      if (parts(executor).axis.is_locked()) return with_status(Status::command_not_available, command);
      search.start();
      break;
    case SearchAction::stop:
      search.abort();
      break;
    case SearchAction::status:
      return result(static_cast<std::int32_t>(search.state()));
  }
  return done(command);
}

Outcome Handlers::set_coordinate(Executor& executor, const Command& command) {
  GlobalParameterAccess& globals = parts(executor).global_parameters;
  const Status status = command.motor == all_motors ? globals.store_coordinates(command.type)
                                                    : globals.set_coordinate(command.type, command.value);
  return with_status(status, command);
}

Outcome Handlers::get_coordinate(Executor& executor, const Command& command) {
  GlobalParameterAccess& globals = parts(executor).global_parameters;
  if (command.motor == all_motors) {
    globals.restore_coordinates(command.type);
    return done(command);
  }
  return result(globals.coordinate(command.type));
}

Outcome Handlers::capture_coordinate(Executor& executor, const Command& command) {
  const std::int32_t position = parts(executor).axis.position();
  const Status status = parts(executor).global_parameters.set_coordinate(command.type, position);
  return {status, position, Outcome::Form::normal};
}

Outcome Handlers::accumulator_to_coordinate(Executor& executor, const Command& command) {
  return with_status(parts(executor).global_parameters.set_coordinate(command.type, registers(executor).accumulator),
                     command);
}

}  // namespace opentmcl
