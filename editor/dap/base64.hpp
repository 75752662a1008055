#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace opentmcl::editor::dap {

/// RFC 4648, section 4, with padding.
std::string base64(const std::vector<std::uint8_t>& bytes);

}  // namespace opentmcl::editor::dap
