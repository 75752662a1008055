#pragma once

#include <cstdint>

#include "firmware/spec/status_codes.hpp"

namespace opentmcl {

/// What an instruction came to.
struct Outcome {
  enum class Form : std::uint8_t {
    normal,       ///< status and value
    result,       ///< likewise, and in a program the value goes to the accumulator and sets the flags
    special,      ///< eight bytes of its own follow the host address: see Executor::special_reply()
    silent,       ///< never answered
    busy,         ///< nothing was done yet: try again on the next turn
    mode_change,  ///< as normal, and its line goes on in the other of binary and ASCII mode
  };

  constexpr Outcome(Status the_status, std::int32_t the_value, Form the_form)
      : value(the_value), status(the_status), form(the_form) {}

  // The largest first: eight bytes together, which handlers return in registers.
  std::int32_t value;
  Status status;
  Form form;
};

}  // namespace opentmcl
