// One module of each kind on the same board, so that all of the firmware is in the image.
#include "boards/size_check/board.hpp"
#include "firmware/hal/hal.hpp"
#include "firmware/module/module.hpp"

namespace opentmcl::size_check {

namespace {

Microseconds now() {
  const Microseconds low = board_registers.time_low;
  return Microseconds{board_registers.time_high} << 32 | low;
}

void sleep_until(Microseconds time) {
  board_registers.wake_low = static_cast<std::uint32_t>(time);
  board_registers.wake_high = static_cast<std::uint32_t>(time >> 32);
  asm volatile("wfi");
}

}  // namespace

[[noreturn]] void run_forever() {
  // On the stack, not static: constant-initialised objects with a vtable would be copied from flash to .data.
  Spi tmc429(0);
  Spi tmc262(1);
  Eeprom eeprom;
  Pins pins;
  Analog analog;
  Encoder encoder;
  Can can;
  Serial usb(0);
  Serial rs485(1);
  const hal::Port ports[] = {{&usb, hal::PortKind::usb}, {&rs485, hal::PortKind::rs485}};
  const Hal hal{tmc429, tmc262, eeprom, pins, analog, encoder, ports, 2, &can};

  // Static, so that their size is counted in .bss.
  static Module first(pd1161, hal);
  static Module second(tmcm1110, hal);
  for (;;) {
    if (board_registers.input_change != 0) {
      first.note_input_change();
      second.note_input_change();
    }
    const Microseconds first_due = first.poll(now());
    const Microseconds second_due = second.poll(now());
    if (first.restart_requested() || second.restart_requested()) {
      board_registers.restart = 1;
    }
    sleep_until(first_due < second_due ? first_due : second_due);
  }
}

}  // namespace opentmcl::size_check
