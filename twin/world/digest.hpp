// A number that two runs share as long as they are the same.
#pragma once

#include <cstdint>
#include <span>

namespace opentmcl::twin {

class World;

/// FNV-1a with 64 bits: cheap, the same on every machine, and no protection against anybody's intent.
class Digest {
 public:
  void add(std::span<const std::uint8_t> bytes) {
    for (const std::uint8_t byte : bytes) value_ = (value_ ^ byte) * prime;
  }
  /// Low byte first.
  void add(std::uint64_t number) {
    for (int shift = 0; shift < 64; shift += 8) value_ = (value_ ^ (number >> shift & 0xFF)) * prime;
  }

  std::uint64_t value() const { return value_; }

 private:
  static constexpr std::uint64_t prime = 0x100000001B3;
  std::uint64_t value_ = 0xCBF29CE484222325;
};

/// Of everything that can be looked at in `world`: its quantities, the registers of its chips, its EEPROM.
std::uint64_t digest_of(const World& world);

}  // namespace opentmcl::twin
