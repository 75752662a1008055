// The TMCL program over which the interpreter is measured, and how it comes into a module.
#pragma once

#include "firmware/spec/global_parameters.hpp"
#include "firmware/spec/instructions.hpp"
#include "firmware/spec/status_codes.hpp"
#include "firmware/tmcl/arithmetic.hpp"
#include "firmware/wire/datagram.hpp"

namespace opentmcl::bench {

constexpr Command instruction(Opcode opcode, std::uint8_t type = 0, std::uint8_t motor = 0, std::int32_t value = 0) {
  return {static_cast<std::uint8_t>(opcode), type, motor, value};
}
constexpr Command instruction(Opcode opcode, Operation operation, std::uint8_t motor, std::int32_t value) {
  return instruction(opcode, static_cast<std::uint8_t>(operation), motor, value);
}

inline constexpr std::uint8_t greater = 4;  // in condition_words

/// A loop within an endless loop. The jump is taken in half of the passes.
///
///           CALCV LOAD, 0, 100
///           CALC LOAD, 0
///     Loop: CALC ADD, 3
///           COMP 150
///           JC GT, Next
///           CALC ADD, 1
///     Next: DJNZ 0, Loop
///           JA 0
inline constexpr Command program_loop[] = {
    instruction(Opcode::calcv, Operation::load, 0, 100),
    instruction(Opcode::calc, Operation::load, 0, 0),
    instruction(Opcode::calc, Operation::add, 0, 3),
    instruction(Opcode::comp, 0, 0, 150),
    instruction(Opcode::jc, greater, 0, 6),
    instruction(Opcode::calc, Operation::add, 0, 1),
    instruction(Opcode::djnz, 0, 0, 2),
    instruction(Opcode::ja, 0, 0, 0),
};

/// Turns of the main loop in which every instruction was executed at least once.
inline constexpr int turns_to_warm_up = 1000;

template <class Board>
Status execute(Board& board, const Command& command) {
  Datagram reply;
  while (board.module().handle(encode(Request{1, command}), hal::PortKind::usb, board.now(), reply) ==
         Module::Handling::busy) {
    board.module().poll(board.now());
  }
  return decode_reply(reply).status;
}

/// Starts the module and lets it settle.
template <class Board>
void start(Board& board) {
  constexpr int turns_to_start = 16;  // start, and the header of a new EEPROM
  for (int turn = 0; turn < turns_to_start; ++turn) board.module().poll(board.now());
}

/// Downloads the loop, starts it and runs it until nothing happens for the first time any more.
/// @return whether it runs
template <class Board>
bool run_program(Board& board) {
  bool is_loaded = execute(board, instruction(Opcode::enter_download_mode)) == Status::ok;
  for (const Command& command : program_loop) {
    is_loaded = is_loaded && execute(board, command) == Status::command_loaded;
  }
  is_loaded = is_loaded && execute(board, instruction(Opcode::exit_download_mode)) == Status::ok &&
              execute(board, instruction(Opcode::run_application, 1)) == Status::ok;
  for (int turn = 0; turn < turns_to_warm_up; ++turn) board.module().poll(board.now());
  const auto variable = instruction(Opcode::ggp, 0, static_cast<std::uint8_t>(Bank::user_variables));
  Datagram reply;
  board.module().handle(encode(Request{1, variable}), hal::PortKind::usb, board.now(), reply);
  return is_loaded && decode_reply(reply).value > 0;
}

}  // namespace opentmcl::bench
