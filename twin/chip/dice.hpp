// Random numbers for tests that need many cases of many numbers each.
#pragma once

#include <cstdint>
#include <random>

namespace opentmcl::twin {

/// Numbers that are the same on every machine.
class Dice {
 public:
  explicit Dice(std::uint64_t seed) : engine_(seed) {}

  /// 0…limit-1.
  std::uint64_t below(std::uint64_t limit) { return engine_() % limit; }
  std::int32_t between(std::int32_t lowest, std::int32_t highest) {
    return lowest + static_cast<std::int32_t>(below(static_cast<std::uint64_t>(highest - lowest) + 1));
  }
  bool once_in(std::uint64_t times) { return below(times) == 0; }
  /// 0…2^bits-1, small numbers as likely as large ones: each length in bits about as often as any other.
  std::uint64_t of_any_length(unsigned bits) { return below(std::uint64_t{2} << below(bits)); }
  /// The same with either sign.
  std::int32_t signed_of_any_length(unsigned bits) {
    const auto magnitude = static_cast<std::int32_t>(of_any_length(bits));
    return once_in(2) ? -magnitude : magnitude;
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace opentmcl::twin
