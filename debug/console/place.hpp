#pragma once

#include <cstdint>
#include <string_view>

#include "client/error.hpp"
#include "debug/program.hpp"

namespace opentmcl::debug {

/// The address a person means: "12" (a line of the file that `here` is in), "other.inc:12", "*7" (an address), "Loop",
/// "Loop+2". A line without an instruction means the next one with one. Error: usage.
client::Result<std::uint16_t> address_of_place(std::string_view text, const Program& program, std::uint16_t here);

}  // namespace opentmcl::debug
