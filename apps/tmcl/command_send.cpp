// tmcl send: any instruction, and what the module answers.

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>
#include <optional>
#include <sstream>

#include "apps/tmcl/commands.hpp"
#include "apps/tmcl/context.hpp"
#include "firmware/spec/instructions.hpp"
#include "lang/assembler.hpp"
#include "lang/disassembler.hpp"

namespace opentmcl::app {

using client::Error;
using client::ErrorKind;
using client::Result;

namespace {

struct SendOptions {
  std::vector<std::string> words;
  std::string module;
};

std::string hexadecimal(const Datagram& datagram) {
  return fmt::format("{:02X}", fmt::join(datagram.bytes, " "));
}

/// Four numbers: opcode, type, motor, value. Control commands have no other form.
std::optional<Command> parse_numbers(const std::string& text) {
  std::istringstream stream(text);
  long long numbers[4] = {};
  for (long long& number : numbers) {
    if (!(stream >> number)) return std::nullopt;
  }
  std::string rest;
  if (stream >> rest) return std::nullopt;
  for (int i = 0; i < 3; ++i) {
    if (numbers[i] < 0 || numbers[i] > 255) return std::nullopt;
  }
  if (numbers[3] < int32_minimum || numbers[3] > int32_maximum) return std::nullopt;
  return Command{static_cast<std::uint8_t>(numbers[0]), static_cast<std::uint8_t>(numbers[1]),
                 static_cast<std::uint8_t>(numbers[2]), static_cast<std::int32_t>(numbers[3])};
}

Result<Command> parse(const std::string& text, const ModuleDescription& module) {
  if (!text.empty() && text.front() >= '0' && text.front() <= '9') {
    if (const std::optional<Command> command = parse_numbers(text)) return *command;
    return Error{ErrorKind::usage, fmt::format("\"{}\": expected four numbers: opcode, type, motor, value", text), {}};
  }
  const lang::InstructionResult parsed = lang::parse_instruction(text, module);
  fmt::print(stderr, "{}", lang::format(parsed.diagnostics, parsed.sources));
  if (parsed.command) return *parsed.command;
  return Error{ErrorKind::usage, "nothing was sent", {}};
}

const char* name_of(Status status) {
  for (const StatusSpec& row : status_codes) {
    if (row.code == status) return row.name;
  }
  return "unknown status";
}

/// The replies that carry eight bytes of their own instead of status and value.
bool has_special_reply(const Command& command) {
  const auto opcode = static_cast<Opcode>(command.opcode);
  return opcode == Opcode::read_program_memory || (opcode == Opcode::get_firmware_version && command.type == 0);
}

/// What the eight bytes behind the host address mean.
std::string special_meaning(const Command& command, const Datagram& reply, const ModuleDescription& module) {
  if (static_cast<Opcode>(command.opcode) == Opcode::get_firmware_version) {
    return fmt::format("version {}", std::string(reply.bytes + 1, reply.bytes + datagram_size));
  }
  const lang::DisassembledInstruction instruction =
      lang::disassemble_instruction(decode_request(reply).command, module);
  return fmt::format("instruction {}", instruction.text.value_or(instruction.reason));
}

void print(const Context& context, const Datagram& request, const Datagram& reply, const std::string& meaning,
           const nlohmann::ordered_json& fields) {
  if (context.json) {
    nlohmann::ordered_json data{{"request", hexadecimal(request)}, {"reply", hexadecimal(reply)}};
    data.update(fields);
    fmt::print("{}\n", data.dump());
  } else {
    fmt::print("sent      {}\nreceived  {}\n{}\n", hexadecimal(request), hexadecimal(reply), meaning);
  }
}

Result<void> run_send(const Context& context, const SendOptions& options) {
  const Result<Connection> connection = context.connect();
  if (!connection) return connection.error();
  client::Client& client = *connection->client;
  const Result<const ModuleDescription*> module = chosen_module(options.module, client);
  if (!module) return module.error();
  const Result<Command> command = parse(fmt::format("{}", fmt::join(options.words, " ")), **module);
  if (!command) return command.error();
  const Datagram request = encode(Request{client.options().address, *command});

  if (has_special_reply(*command)) {
    const Result<Datagram> reply = client.exchange_raw(*command);
    if (!reply) return reply.error();
    const std::string meaning = special_meaning(*command, *reply, **module);
    print(context, request, *reply, meaning, {{"meaning", meaning}});
    return {};
  }
  const Result<Reply> reply = client.exchange(*command);
  if (!reply) return reply.error();
  const auto status = static_cast<unsigned>(reply->status);
  print(context, request, encode(*reply),
        fmt::format("status {}, {}; value {}", status, name_of(reply->status), reply->value),
        {{"status", status}, {"meaning", name_of(reply->status)}, {"value", reply->value}});
  if (reply->status == Status::ok || reply->status == Status::command_loaded) return {};
  return Error{ErrorKind::refused, fmt::format("the module said {}", name_of(reply->status)), reply->status};
}

}  // namespace

void add_send(CLI::App& app, Context& context) {
  auto options = std::make_shared<SendOptions>();
  CLI::App* command = app.add_subcommand("send", "send one instruction and show the answer")->fallthrough();
  command->footer(
      "Examples:\n  tmcl send \"MVP ABS, 0, 1000\"\n  tmcl send GAP 1, 0\n"
      "  tmcl send 136 1 0 0        opcode, type, motor, value of a command without a mnemonic");
  command->add_option("INSTRUCTION", options->words, "as in a program, or four numbers")->required();
  command->add_option("--module", options->module, "pd1161 or tmcm1110; default: what the module says it is");
  command->callback([&context, options] { context.finish(run_send(context, *options)); });
}

}  // namespace opentmcl::app
