// Which handler executes which instruction. The order here does not matter; that every row of the instruction table
// has exactly one is checked when this is compiled.
#include "firmware/tmcl/dispatch.hpp"

#include "firmware/tmcl/handlers.hpp"

namespace opentmcl {

namespace {

struct Binding {
  Opcode opcode;
  DispatchEntry::Handler handler;
  Reach reach = Reach::module;
};

constexpr Binding bindings[] = {
    {Opcode::ror, Handlers::rotate_right},
    {Opcode::rol, Handlers::rotate_left},
    {Opcode::mst, Handlers::motor_stop},
    {Opcode::mvp, Handlers::move_to_position},
    {Opcode::sap, Handlers::set_axis_parameter},
    {Opcode::gap, Handlers::get_axis_parameter},
    {Opcode::stap, Handlers::store_axis_parameter},
    {Opcode::rsap, Handlers::restore_axis_parameter},
    {Opcode::sgp, Handlers::set_global_parameter},
    {Opcode::ggp, Handlers::get_global_parameter},
    {Opcode::stgp, Handlers::store_global_parameter},
    {Opcode::rsgp, Handlers::restore_global_parameter},
    {Opcode::rfs, Handlers::reference_search},
    {Opcode::sio, Handlers::set_output},
    {Opcode::gio, Handlers::get_input},
    {Opcode::calc, Handlers::calculate_accumulator, Reach::program},
    {Opcode::comp, Handlers::compare, Reach::program},
    {Opcode::jc, Handlers::jump_conditional, Reach::program},
    {Opcode::ja, Handlers::jump, Reach::program},
    {Opcode::csub, Handlers::call, Reach::program},
    {Opcode::rsub, Handlers::return_from_subroutine, Reach::program},
    {Opcode::ei, Handlers::enable_interrupt},
    {Opcode::di, Handlers::disable_interrupt},
    {Opcode::wait, Handlers::wait},
    {Opcode::stop, Handlers::stop},
    {Opcode::sco, Handlers::set_coordinate},
    {Opcode::gco, Handlers::get_coordinate},
    {Opcode::cco, Handlers::capture_coordinate},
    {Opcode::calcx, Handlers::calculate_x, Reach::program},
    {Opcode::aap, Handlers::accumulator_to_axis_parameter},
    {Opcode::agp, Handlers::accumulator_to_global_parameter},
    {Opcode::cle, Handlers::clear_error_flags, Reach::program},
    {Opcode::vect, Handlers::set_interrupt_vector},
    {Opcode::reti, Handlers::return_from_interrupt},
    {Opcode::aco, Handlers::accumulator_to_coordinate},
    {Opcode::calcvv, Handlers::variable_with_variable, Reach::program},
    {Opcode::calcva, Handlers::variable_with_accumulator, Reach::program},
    {Opcode::calcav, Handlers::accumulator_with_variable, Reach::program},
    {Opcode::calcvx, Handlers::variable_with_x, Reach::program},
    {Opcode::calcxv, Handlers::x_with_variable, Reach::program},
    {Opcode::calcv, Handlers::variable_with_value, Reach::program},
    {Opcode::mvpa, Handlers::move_to_accumulator},
    {Opcode::rst, Handlers::restart},
    {Opcode::djnz, Handlers::decrement_and_jump, Reach::program},
    {Opcode::rola, Handlers::rotate_left_accumulator},
    {Opcode::rora, Handlers::rotate_right_accumulator},
    {Opcode::siv, Handlers::set_indexed_variable, Reach::program},
    {Opcode::giv, Handlers::get_indexed_variable},
    {Opcode::aiv, Handlers::accumulator_to_indexed_variable, Reach::program},
    {Opcode::uf0, Handlers::user_function},
    {Opcode::uf1, Handlers::user_function},
    {Opcode::uf2, Handlers::user_function},
    {Opcode::uf3, Handlers::user_function},
    {Opcode::uf4, Handlers::user_function},
    {Opcode::uf5, Handlers::user_function},
    {Opcode::uf6, Handlers::user_function},
    {Opcode::uf7, Handlers::user_function},
    {Opcode::call, Handlers::call_conditional, Reach::program},
    {Opcode::stop_application, Handlers::stop_application},
    {Opcode::run_application, Handlers::run_application},
    {Opcode::step_application, Handlers::step_application},
    {Opcode::reset_application, Handlers::reset_application},
    {Opcode::enter_download_mode, Handlers::enter_download_mode},
    {Opcode::exit_download_mode, Handlers::exit_download_mode},
    {Opcode::read_program_memory, Handlers::read_program_memory},
    {Opcode::get_application_status, Handlers::get_application_status},
    {Opcode::get_firmware_version, Handlers::get_firmware_version},
    {Opcode::restore_factory_settings, Handlers::restore_factory_settings},
    {Opcode::request_position_reached, Handlers::request_position_reached},
    {Opcode::enter_ascii_mode, Handlers::enter_ascii_mode},
    {Opcode::get_information, Handlers::not_available},
    {Opcode::software_reset, Handlers::software_reset},
};

static_assert(sizeof bindings / sizeof bindings[0] == instruction_count);

constexpr std::uint8_t any = 255;

consteval DispatchEntry refusing_entry() {
  return {nullptr, 0, 0, Status::invalid_command, Status::invalid_command, any, false, any, -1, Reach::module};
}

consteval DispatchEntry entry_of(const InstructionSpec& spec, const ModuleDescription& module, const Binding& binding) {
  DispatchEntry entry{binding.handler, int32_minimum, ~std::uint32_t{0}, Status::ok, Status::ok, any, false, any, -1,
                      binding.reach};
  if (spec.where == Where::program_only) entry.in_direct_mode = Status::command_not_available;
  if (spec.where == Where::direct_only) entry.in_program = Status::command_not_available;
  for (const OperandSpec& operand : spec.operands) {
    switch (operand.field) {
      case Field::type:
        entry.maximum_type = static_cast<std::uint8_t>(operand.maximum);
        entry.excluded_type = static_cast<std::int16_t>(keywords_of(operand.kind).excluded);
        break;
      case Field::motor:
        if (operand.kind == OperandKind::motor || operand.kind == OperandKind::motor_or_all) {
          entry.maximum_motor = static_cast<std::uint8_t>(module.axis_count - 1);
          entry.takes_all_motors = operand.kind == OperandKind::motor_or_all;
        }
        break;
      case Field::value:
        entry.minimum_value = operand.minimum;
        entry.value_range = static_cast<std::uint32_t>(operand.maximum) - static_cast<std::uint32_t>(operand.minimum);
        // Jumps find their targets checked. Control commands and VECT have something to say first.
        if (operand.kind == OperandKind::address && spec.where == Where::program_only) {
          entry.value_range = module.program_capacity - 1U;
        }
        break;
      case Field::none:
        break;
    }
  }
  return entry;
}

consteval DispatchTable make_dispatch_table(const ModuleDescription& module) {
  DispatchTable table{};
  table.entries[instruction_count] = refusing_entry();
  for (std::uint8_t& row : table.by_opcode) row = instruction_count;
  for (const Binding& binding : bindings) {
    const std::size_t row = row_of(binding.opcode);
    if (!contains(instructions[row].modules, module.id)) {
      table.entries[row] = refusing_entry();
      continue;
    }
    table.entries[row] = entry_of(instructions[row], module, binding);
    table.by_opcode[static_cast<std::uint8_t>(binding.opcode)] = static_cast<std::uint8_t>(row);
  }
  return table;
}

/// Each row of the instruction table was bound: the count is right, and none was bound twice.
consteval bool every_row_has_a_handler() {
  bool bound[instruction_count] = {};
  for (const Binding& binding : bindings) bound[row_of(binding.opcode)] = true;
  for (const bool row : bound) {
    if (!row) return false;
  }
  return true;
}
static_assert(every_row_has_a_handler());

/// The handler that answers `status`.
DispatchEntry::Handler handler_refusing(Status status) {
  switch (status) {
    case Status::wrong_type:
      return Handlers::wrong_type;
    case Status::invalid_value:
      return Handlers::invalid_value;
    case Status::command_not_available:
      return Handlers::not_available;
    default:
      return Handlers::invalid_command;
  }
}

}  // namespace

constexpr DispatchTable dispatch_tables[module_count] = {make_dispatch_table(tmcm1110), make_dispatch_table(pd1161)};

DecodedInstruction decode(const DispatchTable& table, const Command& command, Reach& reach) {
  const DispatchEntry& entry = table[command.opcode];
  const Status status = entry.in_program != Status::ok ? entry.in_program : entry.check_fields(command);
  reach = status == Status::ok ? entry.reach : Reach::module;
  return {status == Status::ok ? entry.handler : handler_refusing(status), command};
}

}  // namespace opentmcl
