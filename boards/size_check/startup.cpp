// What a Cortex-M does between power-on and the program: take the stack and the reset handler from the vector table
// at address 0, clear .bss. There is nothing to copy to .data and no constructor to call: check_image.py refuses both.
#include <cstdint>

#include "boards/size_check/board.hpp"

extern "C" {
// Defined by the linker script; only their addresses mean something.
extern std::uint32_t stack_top;
extern std::uint32_t bss_begin;
extern std::uint32_t bss_end;

[[noreturn]] void reset() {
  for (std::uint32_t* word = &bss_begin; word != &bss_end; ++word) {
    *word = 0;
  }
  opentmcl::size_check::run_forever();
}
}

namespace {

[[noreturn]] void halt() {
  for (;;) {
  }
}

using Handler = void (*)();

/// The part of the vector table that the core itself needs: initial stack pointer, reset, and the faults.
struct VectorTable {
  std::uint32_t* initial_stack_pointer;
  Handler reset;
  Handler exceptions[14];
};

[[gnu::section(".vectors"), gnu::used]] const VectorTable vector_table = {
    &stack_top, reset, {halt, halt, halt, halt, halt, halt, halt, halt, halt, halt, halt, halt, halt, halt}};

}  // namespace
