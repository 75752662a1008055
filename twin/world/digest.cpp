#include "twin/world/digest.hpp"

#include <array>
#include <bit>

#include "twin/world/quantities.hpp"
#include "twin/world/world.hpp"

namespace opentmcl::twin {

namespace {

void add_tmc429(Digest& digest, const Tmc429& chip) {
  constexpr unsigned addresses = 64;  // two bits for the motor or the common block, four for the register
  for (unsigned address = 0; address < addresses; ++address) {
    digest.add(chip.read(tmc429::read_datagram(static_cast<tmc429::Address>(address))));
  }
}

void add_tmc262(Digest& digest, const Tmc262& chip) {
  for (const std::uint32_t word :
       {chip.driver_control().bits, chip.spi_coil_currents().bits, chip.chopper_configuration().bits,
        chip.cool_step_control().bits, chip.stall_guard_and_current().bits, chip.driver_configuration().bits}) {
    digest.add(word);
  }
}

void add_eeprom(Digest& digest, const World& world) {
  std::array<std::uint8_t, Eeprom::page_size> page{};
  for (std::size_t address = 0; address < Eeprom::size; address += page.size()) {
    world.read_eeprom(static_cast<std::uint16_t>(address), page.data(), page.size());
    digest.add(page);
  }
}

}  // namespace

std::uint64_t digest_of(const World& world) {
  Digest digest;
  digest.add(world.now());
  for (const Quantity& quantity : quantities()) {
    if (quantity.exists_in(world)) digest.add(std::bit_cast<std::uint64_t>(quantity.read(world)));
  }
  add_tmc429(digest, world.tmc429());
  add_tmc262(digest, world.tmc262());
  add_eeprom(digest, world);
  return digest.value();
}

}  // namespace opentmcl::twin
