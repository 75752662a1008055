// Which handler executes which instruction. The order here does not matter; that every row of the instruction table
// has exactly one is checked when this is compiled.
#include "firmware/tmcl/handlers.hpp"

namespace opentmcl {

namespace {

struct Binding {
  Opcode opcode;
  Handlers::Handler handler;
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
    {Opcode::calc, Handlers::calculate_accumulator},
    {Opcode::comp, Handlers::compare},
    {Opcode::jc, Handlers::jump_conditional},
    {Opcode::ja, Handlers::jump},
    {Opcode::csub, Handlers::call},
    {Opcode::rsub, Handlers::return_from_subroutine},
    {Opcode::ei, Handlers::enable_interrupt},
    {Opcode::di, Handlers::disable_interrupt},
    {Opcode::wait, Handlers::wait},
    {Opcode::stop, Handlers::stop},
    {Opcode::sco, Handlers::set_coordinate},
    {Opcode::gco, Handlers::get_coordinate},
    {Opcode::cco, Handlers::capture_coordinate},
    {Opcode::calcx, Handlers::calculate_x},
    {Opcode::aap, Handlers::accumulator_to_axis_parameter},
    {Opcode::agp, Handlers::accumulator_to_global_parameter},
    {Opcode::cle, Handlers::clear_error_flags},
    {Opcode::vect, Handlers::set_interrupt_vector},
    {Opcode::reti, Handlers::return_from_interrupt},
    {Opcode::aco, Handlers::accumulator_to_coordinate},
    {Opcode::calcvv, Handlers::variable_with_variable},
    {Opcode::calcva, Handlers::variable_with_accumulator},
    {Opcode::calcav, Handlers::accumulator_with_variable},
    {Opcode::calcvx, Handlers::variable_with_x},
    {Opcode::calcxv, Handlers::x_with_variable},
    {Opcode::calcv, Handlers::variable_with_value},
    {Opcode::mvpa, Handlers::move_to_accumulator},
    {Opcode::rst, Handlers::restart},
    {Opcode::djnz, Handlers::decrement_and_jump},
    {Opcode::rola, Handlers::rotate_left_accumulator},
    {Opcode::rora, Handlers::rotate_right_accumulator},
    {Opcode::siv, Handlers::set_indexed_variable},
    {Opcode::giv, Handlers::get_indexed_variable},
    {Opcode::aiv, Handlers::accumulator_to_indexed_variable},
    {Opcode::uf0, Handlers::no_user_function},
    {Opcode::uf1, Handlers::no_user_function},
    {Opcode::uf2, Handlers::no_user_function},
    {Opcode::uf3, Handlers::no_user_function},
    {Opcode::uf4, Handlers::no_user_function},
    {Opcode::uf5, Handlers::no_user_function},
    {Opcode::uf6, Handlers::no_user_function},
    {Opcode::uf7, Handlers::no_user_function},
    {Opcode::call, Handlers::call_conditional},
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
    {Opcode::enter_ascii_mode, Handlers::not_available},
    {Opcode::get_information, Handlers::not_available},
    {Opcode::software_reset, Handlers::software_reset},
};

static_assert(sizeof bindings / sizeof bindings[0] == instruction_count);

struct HandlerTable {
  Handlers::Handler rows[instruction_count];
};

consteval HandlerTable make_handler_table() {
  HandlerTable table{};
  for (const Binding& binding : bindings) table.rows[row_of(binding.opcode)] = binding.handler;
  return table;
}

constexpr HandlerTable handler_table = make_handler_table();

consteval bool every_row_has_a_handler() {
  for (const Handlers::Handler handler : handler_table.rows) {
    if (handler == nullptr) return false;
  }
  return true;
}
static_assert(every_row_has_a_handler());

}  // namespace

Handlers::Handler Handlers::of_row(std::size_t row) {
  return handler_table.rows[row];
}

}  // namespace opentmcl
