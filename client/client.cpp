#include "client/client.hpp"

#include <algorithm>
#include <cstdio>

#include "client/commands.hpp"
#include "firmware/spec/instructions.hpp"

namespace opentmcl::client {

namespace {

/// A module forgets half a datagram after 5 ms without a byte (docs/decisions/0002-framing.md); with twice that much
/// silence both sides stand before a first byte.
constexpr Duration silence = std::chrono::milliseconds(10);

/// A line that never falls silent is not a TMCL module's.
constexpr Duration resynchronisation_limit = std::chrono::seconds(1);

std::string describe(const Command& command) {
  for (const InstructionSpec& row : instructions) {
    if (static_cast<std::uint8_t>(row.opcode) == command.opcode && row.mnemonic != nullptr) return row.mnemonic;
  }
  return "command " + std::to_string(command.opcode);
}

std::string hexadecimal(const Datagram& datagram) {
  std::string text;
  for (const std::uint8_t byte : datagram.bytes) {
    char digits[4];
    std::snprintf(digits, sizeof digits, "%02X ", byte);
    text += digits;
  }
  text.pop_back();
  return text;
}

Error refusal(const Command& command, Status status) {
  if (status == Status::command_loaded) {
    return {ErrorKind::refused,
            "the module is in download mode: it made " + describe(command) +
                " a part of its program instead of executing it. Command 133 ends that mode",
            status};
  }
  std::string meaning = "a status no manual lists";
  for (const StatusSpec& row : status_codes) {
    if (row.code == status) meaning = std::string(row.name) + ". " + row.description;
  }
  return {ErrorKind::refused,
          "the module refused " + describe(command) + ": status " + std::to_string(static_cast<unsigned>(status)) +
              ", " + meaning,
          status};
}

}  // namespace

const ModuleDescription* FirmwareVersion::module() const {
  for (const ModuleDescription& description : modules) {
    if (description.type_number == type_number) return &description;
  }
  return nullptr;
}

const char* name_of(ProgramStatus::State state) {
  switch (state) {
    case ProgramStatus::State::stopped:
      return "stopped";
    case ProgramStatus::State::running:
      return "running";
    case ProgramStatus::State::stepping:
      return "stepping";
    case ProgramStatus::State::reset:
      return "reset";
  }
  return "unknown";
}

Result<Reply> Client::exchange(const Command& command) {
  if (Result<void> sent = send(command); !sent) return sent.error();
  return receive_reply(command);
}

Result<std::int32_t> Client::execute(const Command& command) {
  Result<Reply> reply = exchange(command);
  if (!reply) return reply.error();
  if (reply->status != Status::ok) return refusal(command, reply->status);
  return reply->value;
}

Result<Datagram> Client::exchange_raw(const Command& command) {
  if (Result<void> sent = send(command); !sent) return sent.error();
  return receive();
}

Result<void> Client::send(const Command& command) {
  if (out_of_step_) resynchronise();
  transport_.drain();
  const Datagram request = encode(Request{options_.address, command});
  return transport_.send(request.bytes);
}

Result<Datagram> Client::receive() {
  Datagram datagram;
  std::size_t received = 0;
  const Duration deadline = transport_.now() + options_.time_limit;
  while (received < datagram_size) {
    const Duration left = std::max(Duration(0), deadline - transport_.now());
    Result<std::size_t> count = transport_.receive(std::span(datagram.bytes).subspan(received), left);
    if (!count) return count.error();
    received += *count;
    if (*count > 0 || left > Duration(0)) continue;

    out_of_step_ = true;
    const std::string how_long = std::to_string(options_.time_limit / std::chrono::milliseconds(1)) + " ms";
    if (received == 0) {
      return Error{ErrorKind::timeout,
                   "no answer from " + transport_.name() + " within " + how_long +
                       ": is this the port of a TMCL module, its address " + std::to_string(options_.address) +
                       ", the baud rate right?",
                   {}};
    }
    return Error{
        ErrorKind::timeout,
        "only " + std::to_string(received) + " of 9 bytes came from " + transport_.name() + " within " + how_long,
        {}};
  }
  return datagram;
}

Result<Reply> Client::receive_reply(const Command& command) {
  while (true) {
    Result<Datagram> datagram = receive();
    if (!datagram) return datagram.error();
    if (!datagram->checksum_is_right()) {
      out_of_step_ = true;
      return Error{ErrorKind::protocol,
                   "an answer with a wrong checksum came from " + transport_.name() + ": " + hexadecimal(*datagram),
                   {}};
    }
    const Reply reply = decode_reply(*datagram);
    // The second reply of command 138 answers no request: it comes when the motor is there.
    if (reply.status == Status::position_reached) continue;
    // A module that received a wrong checksum cannot repeat the opcode and says 0.
    if (reply.opcode != command.opcode && reply.status != Status::wrong_checksum) {
      out_of_step_ = true;
      return Error{ErrorKind::protocol,
                   "the answer from " + transport_.name() + " belongs to command " + std::to_string(reply.opcode) +
                       ", not to " + describe(command) + ": " + hexadecimal(*datagram),
                   {}};
    }
    return reply;
  }
}

void Client::resynchronise() {
  std::uint8_t dropped[64];
  const Duration give_up = transport_.now() + resynchronisation_limit;
  while (transport_.now() < give_up) {
    const Result<std::size_t> count = transport_.receive(dropped, silence);
    if (!count || *count == 0) break;
  }
  out_of_step_ = false;
}

Result<std::int32_t> Client::read(const Command& command, bool repeatable) {
  const unsigned attempts = repeatable ? std::max(1U, options_.read_attempts) : 1;
  for (unsigned attempt = 1;; ++attempt) {
    Result<std::int32_t> value = execute(command);
    if (value.ok() || attempt >= attempts) return value;
    const ErrorKind kind = value.error().kind;
    const bool broken_on_the_way =
        kind == ErrorKind::timeout || kind == ErrorKind::protocol || value.error().status == Status::wrong_checksum;
    if (!broken_on_the_way) return value;
  }
}

Result<void> Client::change(const Command& command) {
  const Result<std::int32_t> value = execute(command);
  if (!value) return value.error();
  return {};
}

Result<std::int32_t> Client::axis_parameter(std::uint8_t number, std::uint8_t motor) {
  // Reading the extended error flags clears them: what a lost answer said is gone.
  const bool repeatable = number != static_cast<std::uint8_t>(AxisParameter::extended_error_flags);
  return read(commands::get_axis_parameter(number, motor), repeatable);
}

Result<void> Client::set_axis_parameter(std::uint8_t number, std::int32_t value, std::uint8_t motor) {
  return change(commands::set_axis_parameter(number, value, motor));
}

Result<void> Client::store_axis_parameter(std::uint8_t number, std::uint8_t motor) {
  return change(commands::store_axis_parameter(number, motor));
}

Result<void> Client::restore_axis_parameter(std::uint8_t number, std::uint8_t motor) {
  return change(commands::restore_axis_parameter(number, motor));
}

Result<std::int32_t> Client::global_parameter(std::uint8_t number, Bank bank) {
  return read(commands::get_global_parameter(number, bank), true);
}

Result<void> Client::set_global_parameter(std::uint8_t number, Bank bank, std::int32_t value) {
  return change(commands::set_global_parameter(number, bank, value));
}

Result<void> Client::store_global_parameter(std::uint8_t number, Bank bank) {
  return change(commands::store_global_parameter(number, bank));
}

Result<void> Client::restore_global_parameter(std::uint8_t number, Bank bank) {
  return change(commands::restore_global_parameter(number, bank));
}

Result<void> Client::rotate(std::int32_t velocity, std::uint8_t motor) {
  return change(commands::rotate(velocity, motor));
}

Result<void> Client::move_to(std::int32_t position, std::uint8_t motor) {
  return change(commands::move_to(position, motor));
}

Result<void> Client::move_by(std::int32_t distance, std::uint8_t motor) {
  return change(commands::move_by(distance, motor));
}

Result<void> Client::move_to_coordinate(std::uint8_t coordinate, std::uint8_t motor) {
  return change(commands::move_to_coordinate(coordinate, motor));
}

Result<void> Client::stop(std::uint8_t motor) {
  return change(commands::stop(motor));
}

Result<void> Client::start_reference_search(std::uint8_t motor) {
  return change(commands::start_reference_search(motor));
}

Result<void> Client::stop_reference_search(std::uint8_t motor) {
  return change(commands::stop_reference_search(motor));
}

Result<std::int32_t> Client::reference_search_status(std::uint8_t motor) {
  return read(commands::reference_search_status(motor), true);
}

Result<std::int32_t> Client::input_output(std::uint8_t port, IoBank bank) {
  return read(commands::get_input_output(port, bank), true);
}

Result<void> Client::set_output(std::uint8_t port, IoBank bank, std::int32_t value) {
  return change(commands::set_output(port, bank, value));
}

Result<std::int32_t> Client::coordinate(std::uint8_t number, std::uint8_t motor) {
  return read(commands::get_coordinate(number, motor), true);
}

Result<void> Client::set_coordinate(std::uint8_t number, std::int32_t position, std::uint8_t motor) {
  return change(commands::set_coordinate(number, position, motor));
}

Result<void> Client::capture_coordinate(std::uint8_t number, std::uint8_t motor) {
  return change(commands::capture_coordinate(number, motor));
}

Result<void> Client::start_program() {
  if (Result<void> reset = change(commands::reset_application()); !reset) return reset;
  return change(commands::run_application());
}

Result<void> Client::stop_program() {
  return change(commands::stop_application());
}

Result<ProgramStatus> Client::program_status() {
  const Result<std::int32_t> value =
      read(commands::get_application_status(commands::ApplicationStatus::with_program_counter), true);
  if (!value) return value.error();
  const auto bits = static_cast<std::uint32_t>(*value);
  return ProgramStatus{static_cast<ProgramStatus::State>(bits >> 24), (bits >> 16 & 0xFF) != 0,
                       static_cast<std::uint16_t>(bits & 0xFFFF)};
}

Result<std::int32_t> Client::accumulator() {
  return read(commands::get_application_status(commands::ApplicationStatus::accumulator), true);
}

Result<std::int32_t> Client::x_register() {
  return read(commands::get_application_status(commands::ApplicationStatus::x_register), true);
}

Result<FirmwareVersion> Client::firmware_version() {
  const Result<std::int32_t> value = read(commands::get_firmware_version(), true);
  if (!value) return value.error();
  const auto bits = static_cast<std::uint32_t>(*value);
  return FirmwareVersion{static_cast<std::uint16_t>(bits >> 16), static_cast<std::uint8_t>(bits >> 8),
                         static_cast<std::uint8_t>(bits)};
}

Result<std::string> Client::firmware_version_text() {
  const Result<Datagram> reply = exchange_raw(commands::get_firmware_version_text());
  if (!reply) return reply.error();
  const std::string text(reply->bytes + 1, reply->bytes + datagram_size);
  const bool printable = std::all_of(text.begin(), text.end(), [](char c) { return c >= ' ' && c <= '~'; });
  if (!printable) {
    out_of_step_ = true;
    return Error{
        ErrorKind::protocol, "no version text came from " + transport_.name() + ": " + hexadecimal(*reply), {}};
  }
  return text;
}

}  // namespace opentmcl::client
