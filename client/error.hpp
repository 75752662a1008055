// What can go wrong between a host and a module, and the two forms a function's answer can take.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <variant>

#include "firmware/spec/status_codes.hpp"

namespace opentmcl::client {

enum class ErrorKind : std::uint8_t {
  refused,         ///< the module answered with an error status
  usage,           ///< a wrong option, name or number from the user
  bad_file,        ///< a source or data file that cannot be used
  no_such_device,  ///< nothing to connect to, or no permission, or somebody else has it
  internal,        ///< a bug of this program
  input_output,    ///< the port is gone, or the operating system refused an operation
  timeout,         ///< no answer within the time limit
  protocol,        ///< an answer that is none: wrong checksum, or to another command
  interrupted,     ///< the user pressed Ctrl-C
};

/// The exit codes of `tmcl`; 64 to 78 mean what sysexits.h says.
constexpr int exit_code_of(ErrorKind kind) {
  switch (kind) {
    case ErrorKind::refused:
      return 1;
    case ErrorKind::usage:
      return 64;
    case ErrorKind::bad_file:
      return 65;
    case ErrorKind::no_such_device:
      return 69;
    case ErrorKind::internal:
      return 70;
    case ErrorKind::input_output:
      return 74;
    case ErrorKind::timeout:
      return 75;
    case ErrorKind::protocol:
      return 76;
    case ErrorKind::interrupted:
      return 130;
  }
  return 70;
}

struct Error {
  ErrorKind kind;
  std::string message;           ///< one sentence or two: what, where, what was expected, what to do
  std::optional<Status> status;  ///< what the module said, for ErrorKind::refused
};

/// A value, or the reason why there is none.
template <class T>
class [[nodiscard]] Result {
 public:
  // Both implicit, so that a function can return either.
  Result(T value) : state_(std::in_place_index<0>, std::move(value)) {}      // NOLINT(google-explicit-constructor)
  Result(Error error) : state_(std::in_place_index<1>, std::move(error)) {}  // NOLINT(google-explicit-constructor)

  bool ok() const { return state_.index() == 0; }
  explicit operator bool() const { return ok(); }

  /// @pre ok()
  T& value() { return std::get<0>(state_); }
  const T& value() const { return std::get<0>(state_); }
  T& operator*() { return value(); }
  const T& operator*() const { return value(); }
  T* operator->() { return &value(); }
  const T* operator->() const { return &value(); }

  /// @pre !ok()
  const Error& error() const { return std::get<1>(state_); }

 private:
  std::variant<T, Error> state_;
};

/// Done, or the reason why not.
template <>
class [[nodiscard]] Result<void> {
 public:
  Result() = default;
  Result(Error error) : error_(std::move(error)) {}  // NOLINT(google-explicit-constructor)

  bool ok() const { return !error_.has_value(); }
  explicit operator bool() const { return ok(); }

  /// @pre !ok()
  const Error& error() const { return *error_; }

 private:
  std::optional<Error> error_;
};

}  // namespace opentmcl::client
