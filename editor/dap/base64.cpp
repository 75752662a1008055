#include "editor/dap/base64.hpp"

#include <cstddef>
#include <string_view>

namespace opentmcl::editor::dap {

std::string base64(const std::vector<std::uint8_t>& bytes) {
  constexpr std::string_view digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  constexpr std::size_t group_size = 3;
  std::string text;
  for (std::size_t begin = 0; begin < bytes.size(); begin += group_size) {
    std::uint32_t group = 0;
    for (std::size_t i = begin; i < begin + group_size; ++i) group = group << 8 | (i < bytes.size() ? bytes[i] : 0U);
    for (std::size_t digit = 0; digit <= group_size; ++digit) {
      const bool is_padding = begin + digit > bytes.size();
      text += is_padding ? '=' : digits[group >> (6 * (group_size - digit)) & 63U];
    }
  }
  return text;
}

}  // namespace opentmcl::editor::dap
