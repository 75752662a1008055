// Registers of a chip as types: the bits of two registers cannot be mixed, that does not compile.
#pragma once

#include <cstdint>

namespace opentmcl::chip {

/// The content of one register. `Register` is the type that describes it and holds its fields.
template <class Register>
struct Word {
  std::uint32_t bits = 0;

  friend constexpr Word operator|(Word left, Word right) { return {left.bits | right.bits}; }
  friend constexpr bool operator==(Word left, Word right) { return left.bits == right.bits; }
};

/// Some adjacent bits of a register: `field_width` bits, the lowest of them at bit `field_shift`.
/// A signed field is two's complement.
template <class Register, unsigned field_shift, unsigned field_width, bool is_signed = false>
struct Field {
  static_assert(field_width >= 1 && field_shift + field_width <= 32);

  static constexpr unsigned shift = field_shift;
  static constexpr unsigned width = field_width;
  static constexpr std::uint32_t mask = (0xFFFF'FFFFu >> (32 - width)) << shift;  ///< in place
  static constexpr std::int32_t minimum = is_signed ? -(std::int32_t{1} << (width - 1)) : 0;
  static constexpr std::int32_t maximum =
      static_cast<std::int32_t>((0xFFFF'FFFFu >> (32 - width)) >> (is_signed ? 1 : 0));

  /// A word in which only this field is set. Bits of `value` beyond the width are lost, as in the chip.
  static constexpr Word<Register> of(std::int32_t value) {
    return {(static_cast<std::uint32_t>(value) << shift) & mask};
  }

  /// The field's value, sign extended when it is signed.
  static constexpr std::int32_t in(Word<Register> word) {
    if constexpr (is_signed) {
      return static_cast<std::int32_t>(word.bits << (32 - shift - width)) >> (32 - width);
    } else {
      return static_cast<std::int32_t>((word.bits & mask) >> shift);
    }
  }

  static constexpr bool is_set(Word<Register> word) { return (word.bits & mask) != 0; }

  static constexpr Word<Register> replaced(Word<Register> word, std::int32_t value) {
    return {(word.bits & ~mask) | of(value).bits};
  }
};

/// A field of a single bit, for use in words that are put together: `EnableStepDir::set | RightSwitches::set`.
template <class Register, unsigned bit>
struct Flag : Field<Register, bit, 1> {
  static constexpr Word<Register> set{std::uint32_t{1} << bit};
};

}  // namespace opentmcl::chip
