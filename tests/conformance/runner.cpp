#include "tests/conformance/runner.hpp"

#include <algorithm>
#include <cstdio>
#include <variant>

#include "tests/conformance/bench_names.hpp"
#include "tests/conformance/step.hpp"
#include "tests/module/bench.hpp"
#include "tests/module/test_can.hpp"

namespace opentmcl::conformance {

namespace {

using Failure = std::optional<std::string>;

constexpr std::uint8_t factory_address = 1;
/// A reply can wait for page writes of the EEPROM, 5 ms each, that were queued before.
constexpr Microseconds longest_reply_time = 500 * one_millisecond;
/// After this time everything is in the EEPROM; to erase a program takes longest, 1.2 s.
constexpr Microseconds eeprom_time = 2'000 * one_millisecond;
/// Silence is believed after this time: replies that need not wait for anything come within a turn of the main loop.
constexpr Microseconds silence = 10 * one_millisecond;
constexpr Microseconds step_time = 100;
/// The last page writes of a download go on behind the last reply; a program that is started meanwhile begins later.
constexpr Microseconds download_time = 50 * one_millisecond;

std::string as_text(const Bytes& bytes) {
  if (bytes.empty()) return "nothing";
  std::string text;
  for (const std::uint8_t byte : bytes) {
    char digits[8];
    std::snprintf(digits, sizeof digits, "%02X ", byte);
    text += digits;
  }
  text.pop_back();
  return text;
}

std::string as_text(const Range& range) {
  std::string text = std::to_string(range.minimum);
  if (range.maximum != range.minimum) text += " to " + std::to_string(range.maximum);
  return text;
}

std::string as_text(const hal::CanFrame& frame) {
  char id[16];
  std::snprintf(id, sizeof id, frame.is_extended ? "%08X " : "%03X ", static_cast<unsigned>(frame.id));
  return id + as_text(Bytes(frame.data, frame.data + frame.length));
}

bool are_equal(const hal::CanFrame& left, const hal::CanFrame& right) {
  return left.id == right.id && left.is_extended == right.is_extended && left.length == right.length &&
         std::equal(left.data, left.data + left.length, right.data);
}

class Runner {
 public:
  Runner(const ModuleDescription& description, hal::PortKind kind)
      : bench_(description, kind, nullptr, options_with(can_bus_)) {}

  tests::Bench& bench() { return bench_; }

  Failure operator()(const SendCommand& step) {
    const std::optional<Reply> reply = exchange(step.command, step.reply ? longest_reply_time : silence);
    if (!step.reply) return reply ? Failure("expected no reply") : std::nullopt;
    if (!reply) return "there is no reply";
    if (static_cast<std::uint8_t>(reply->status) != step.reply->status) {
      return "expected status " + std::to_string(step.reply->status) + ", found " +
             std::to_string(static_cast<int>(reply->status));
    }
    if (reply->opcode != step.command.opcode) return "the reply is to command " + std::to_string(reply->opcode);
    if (step.reply->value && !step.reply->value->contains(reply->value)) {
      return "expected value " + as_text(*step.reply->value) + ", found " + std::to_string(reply->value);
    }
    return std::nullopt;
  }

  Failure operator()(const SendBytes& step) {
    send(step.bytes);
    if (!step.reply.empty()) hear(step.reply.size(), longest_reply_time);
    bench_.wait(silence);  // there must be no more than that
    return compare(step.reply);
  }

  Failure operator()(const SendFrame& step) {
    can_bus_.received.clear();
    can_bus_.to_module.push_back(step.frame);
    bench_.module.wake();
    bench_.wait(silence);
    const std::vector<hal::CanFrame>& received = can_bus_.received;
    if (!step.reply) return received.empty() ? std::nullopt : Failure("expected no frame");
    if (received.size() != 1) return "expected one frame, found " + std::to_string(received.size());
    if (are_equal(received.front(), *step.reply)) return std::nullopt;
    return "expected " + as_text(*step.reply) + ", found " + as_text(received.front());
  }

  Failure operator()(const Receive& step) {
    bench_.port.received.clear();
    if (step.bytes.empty()) {
      bench_.wait(step.limit);
    } else {
      hear(step.bytes.size(), step.limit);
    }
    return compare(step.bytes);
  }

  Failure operator()(const Wait& step) {
    bench_.wait(step.duration);
    return std::nullopt;
  }

  Failure operator()(const WaitUntil& step) {
    const Microseconds begin = bench_.module.now();
    while (true) {
      const std::optional<Reply> reply = exchange(step.command, longest_reply_time);
      if (!reply || reply->status != Status::ok) return "the command is not answered with status 100";
      if (step.value.contains(reply->value)) return std::nullopt;
      if (bench_.module.now() - begin > step.limit) return "the value is still " + std::to_string(reply->value);
      bench_.wait(one_millisecond);
    }
  }

  Failure operator()(const SetWorld& step) {
    set_world(bench_.module.world(), step.name, step.value);
    return std::nullopt;
  }

  Failure operator()(const CheckWorld& step) {
    const std::int64_t value =
        step.name == "can bit rate" ? can_bus_.bit_rate : look_at(bench_.module.world(), step.name);
    if (step.value.contains(value)) return std::nullopt;
    return "expected " + as_text(step.value) + ", found " + std::to_string(value);
  }

  Failure operator()(const PowerCycle&) {
    // What was accepted before is in the EEPROM by then; cutting the power within a write is the subject of other
    // tests.
    bench_.wait(eeprom_time);
    bench_.module.power_cycle();
    bench_.wait(one_millisecond);
    return std::nullopt;
  }

  Failure operator()(const RunProgram& step) {
    constexpr std::uint8_t from_address = 1;
    const Command commands[] = {{static_cast<std::uint8_t>(Opcode::reset_application), 0, 0, 0},
                                {static_cast<std::uint8_t>(Opcode::run_application), from_address, 0, step.address}};
    for (const Command& command : commands) {
      if (Failure failure = (*this)(SendCommand{command, ExpectedReply{}})) return failure;
    }
    return std::nullopt;
  }

 private:
  void send(const Bytes& bytes) {
    bench_.port.received.clear();
    bench_.port.to_module.insert(bench_.port.to_module.end(), bytes.begin(), bytes.end());
    bench_.module.wake();
  }

  void hear(std::size_t count, Microseconds limit) {
    const Microseconds end = bench_.module.now() + limit;
    while (bench_.port.received.size() < count && bench_.module.now() < end) bench_.wait(step_time);
  }

  std::optional<Reply> exchange(const Command& command, Microseconds limit) {
    const Datagram request = encode(Request{factory_address, command});
    send({request.bytes, request.bytes + datagram_size});
    hear(datagram_size, limit);
    if (bench_.port.received.size() < datagram_size) return std::nullopt;
    Datagram reply;
    std::copy_n(bench_.port.received.begin(), datagram_size, reply.bytes);
    if (!reply.checksum_is_right()) return std::nullopt;
    return decode_reply(reply);
  }

  Failure compare(const Bytes& expected) const {
    if (bench_.port.received == expected) return std::nullopt;
    return "expected " + as_text(expected) + ", found " + as_text(bench_.port.received);
  }

  static VirtualModule::Options options_with(tests::TestCan& bus) {
    VirtualModule::Options options;
    options.can = &bus;
    return options;
  }

  tests::TestCan can_bus_;
  tests::Bench bench_;
};

}  // namespace

std::optional<std::string> run(const Statement& statement, ModuleId module) {
  const ModuleDescription& description = modules[static_cast<std::size_t>(module)];
  const std::vector<Step> steps = parse_steps(statement.steps, description);
  Runner runner(description, statement.port);
  if (!statement.program.empty()) {
    runner.bench().download(statement.program);
    runner.bench().wait(download_time);
  }
  for (const Step& step : steps) {
    if (const Failure failure = std::visit(runner, step.action)) return '"' + step.text + "\": " + *failure;
  }
  return std::nullopt;
}

}  // namespace opentmcl::conformance
