// The four functions GCC may call in any program, standard library or not. Compiled with -fno-builtin, or the compiler
// would recognise the loops and make each function call itself.
#include <cstddef>
#include <cstdint>

extern "C" {

void* memcpy(void* to, const void* from, std::size_t length) {
  auto* target = static_cast<std::uint8_t*>(to);
  const auto* source = static_cast<const std::uint8_t*>(from);
  for (std::size_t i = 0; i < length; ++i) {
    target[i] = source[i];
  }
  return to;
}

void* memmove(void* to, const void* from, std::size_t length) {
  auto* target = static_cast<std::uint8_t*>(to);
  const auto* source = static_cast<const std::uint8_t*>(from);
  if (target < source) {
    return memcpy(to, from, length);
  }
  for (std::size_t i = length; i > 0; --i) {
    target[i - 1] = source[i - 1];
  }
  return to;
}

void* memset(void* to, int value, std::size_t length) {
  auto* target = static_cast<std::uint8_t*>(to);
  for (std::size_t i = 0; i < length; ++i) {
    target[i] = static_cast<std::uint8_t>(value);
  }
  return to;
}

int memcmp(const void* left, const void* right, std::size_t length) {
  const auto* first = static_cast<const std::uint8_t*>(left);
  const auto* second = static_cast<const std::uint8_t*>(right);
  for (std::size_t i = 0; i < length; ++i) {
    if (first[i] != second[i]) {
      return first[i] < second[i] ? -1 : 1;
    }
  }
  return 0;
}
}
