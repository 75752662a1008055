#include "tests/parameter_rules/command_stream.hpp"

#include <algorithm>
#include <limits>
#include <sstream>

#include "boards/twin/virtual_module.hpp"
#include "tests/module/bench.hpp"
#include "tests/parameter_rules/reference_module.hpp"

namespace opentmcl::tests {

namespace {

struct Name {
  std::uint8_t opcode;
  const char* text;
};
constexpr Name names[] = {
    {ref_sap, "SAP"}, {ref_gap, "GAP"},   {ref_stap, "STAP"}, {ref_rsap, "RSAP"}, {ref_sgp, "SGP"},
    {ref_ggp, "GGP"}, {ref_stgp, "STGP"}, {ref_rsgp, "RSGP"}, {ref_calc, "CALC"}, {ref_sco, "SCO"},
    {ref_gco, "GCO"}, {ref_cco, "CCO"},   {ref_aap, "AAP"},   {ref_agp, "AGP"},   {ref_aco, "ACO"},
};

constexpr std::uint8_t software_reset_opcode = 255;
constexpr std::uint8_t factory_reset_opcode = 137;
constexpr std::int32_t confirmation = 1234;

/// The same numbers from the same seed with every standard library.
class Dice {
 public:
  explicit Dice(std::mt19937_64& random) : random_(random) {}

  /// 0 to count - 1.
  std::uint32_t below(std::uint32_t count) { return static_cast<std::uint32_t>(random_() % count); }
  bool once_in(std::uint32_t count) { return below(count) == 0; }
  std::uint8_t byte() { return static_cast<std::uint8_t>(random_()); }
  std::int32_t any() { return static_cast<std::int32_t>(static_cast<std::uint32_t>(random_())); }
  std::int32_t between(std::int32_t first, std::int32_t last) {
    const auto count = static_cast<std::uint64_t>(std::int64_t{last} - first + 1);
    return static_cast<std::int32_t>(first + static_cast<std::int64_t>(random_() % count));
  }

 private:
  std::mt19937_64& random_;
};

/// A value for a parameter: mostly within its range or at the edges of it.
std::int32_t value_for(const ParameterRule* rule, Dice& dice) {
  constexpr std::int32_t special[] = {0,    1,    -1,   2,     255,   256,        1234,
                                      4321, 2047, 2048, 65535, 65536, 0x7FFFFFFF, -0x7FFFFFFF - 1};
  if (rule == nullptr || dice.once_in(8)) return dice.any();
  switch (dice.below(6)) {
    case 0:
      return special[dice.below(std::size(special))];
    case 1:
      return rule->default_value;
    case 2: {
      const std::int64_t edge = dice.once_in(2) ? rule->minimum : rule->maximum;
      const std::int64_t value = edge + dice.between(-1, 1);
      return static_cast<std::int32_t>(std::clamp<std::int64_t>(value, std::numeric_limits<std::int32_t>::min(),
                                                                std::numeric_limits<std::int32_t>::max()));
    }
    default:
      return dice.between(rule->minimum, rule->maximum);
  }
}

const ParameterRule* rule_of(ModuleId module, const Command& command) {
  const bool is_axis = command.opcode <= ref_rsap || command.opcode == ref_aap;
  return is_axis ? axis_parameter_rule(module, command.type) : global_parameter_rule(module, command.type);
}

/// A number that some module has, more often than one that nobody has.
std::uint8_t parameter_number(bool is_axis, Dice& dice) {
  for (int attempt = 0; attempt < 40; ++attempt) {
    const std::uint8_t number = dice.byte();
    for (const ModuleId module : {ModuleId::tmcm1110, ModuleId::pd1161}) {
      if ((is_axis ? axis_parameter_rule(module, number) : global_parameter_rule(module, number)) != nullptr) {
        return number;
      }
    }
    if (dice.once_in(12)) return number;
  }
  return dice.byte();
}

Command random_command(ModuleId module, Dice& dice) {
  Command command;
  command.opcode = names[dice.below(std::size(names))].opcode;
  const bool is_axis = command.opcode <= ref_rsap || command.opcode == ref_aap;
  const bool is_coordinate =
      command.opcode == ref_sco || command.opcode == ref_gco || command.opcode == ref_cco || command.opcode == ref_aco;
  if (command.opcode == ref_calc) {
    // Loads a value for some parameter, so that AAP and AGP are often right.
    const bool for_axis = dice.once_in(2);
    const std::uint8_t number = parameter_number(for_axis, dice);
    return {ref_calc, ref_calc_load, 0,
            value_for(for_axis ? axis_parameter_rule(module, number) : global_parameter_rule(module, number), dice)};
  }
  if (is_coordinate) {
    command.type = static_cast<std::uint8_t>(dice.once_in(10) ? dice.byte() : dice.below(21));
    command.motor = static_cast<std::uint8_t>(dice.once_in(5) ? 255 : dice.once_in(10) ? dice.byte() : 0);
    command.value = dice.once_in(3) ? 0 : dice.any();
    return command;
  }
  if (is_axis) {
    command.motor = static_cast<std::uint8_t>(dice.once_in(12) ? dice.byte() : 0);
    command.type = parameter_number(true, dice);
  } else {
    constexpr std::uint8_t banks[] = {0, 0, 0, 0, 2, 2, 3, 1};
    constexpr std::uint8_t interrupts[] = {0, 1, 2, 27, 28, 39, 42, 43, 44, 45};
    command.motor = dice.once_in(15) ? dice.byte() : banks[dice.below(std::size(banks))];
    command.type = command.motor == 0   ? parameter_number(false, dice)
                   : command.motor == 3 ? interrupts[dice.below(std::size(interrupts))]
                   : dice.once_in(2)    ? static_cast<std::uint8_t>(dice.below(58))
                                        : dice.byte();
  }
  constexpr ParameterRule edges{"RW", 0, 3, 0};
  const ParameterRule* rule = !is_axis && command.motor == 3 ? &edges : rule_of(module, command);
  command.value = value_for(rule, dice);
  // Long pauses cost simulated time; a few are enough. What suppresses replies hides what is to be seen.
  const bool is_in_bank_0 = !is_axis && command.motor == 0;
  if (is_in_bank_0 && command.type == 75 && command.value > 3 && !dice.once_in(50)) command.value %= 4;
  if (is_in_bank_0 && command.type == 255 && command.value == 1 && !dice.once_in(4)) command.value = 0;
  // The lock would be closed nearly always.
  if (is_in_bank_0 && command.type == 73 && dice.once_in(2)) command.value = dice.once_in(3) ? 1234 : 4321;
  return command;
}

/// A module with a byte port, executing steps as fast as it can.
class Subject {
 public:
  explicit Subject(ModuleId module)
      : module_(modules[static_cast<std::size_t>(module)], {{&port_, hal::PortKind::rs485}}) {
    wait(one_millisecond);
  }

  /// Sends a request and waits for its reply, `patience` at most.
  std::vector<std::uint8_t> exchange(std::uint8_t address, const Command& command, Microseconds patience) {
    const Datagram request = encode(Request{address, command});
    port_.received.clear();
    port_.to_module.insert(port_.to_module.end(), request.bytes, request.bytes + datagram_size);
    module_.wake();
    const Microseconds deadline = module_.now() + patience;
    module_.advance_to(module_.now());
    while (port_.received.size() < datagram_size && module_.now() < deadline) {
      module_.advance_to(std::clamp(module_.next_turn(), module_.now() + 1, deadline));
    }
    return port_.received;
  }

  /// Lets time pass until the EEPROM has been idle for a while: a restart that was asked for is over, too.
  void settle() {
    constexpr Microseconds quiet = 20 * one_millisecond;
    std::uint64_t written = ~std::uint64_t{0};
    while (written != module_.world().eeprom().bytes_written()) {
      written = module_.world().eeprom().bytes_written();
      wait(quiet);
    }
  }

  void power_cycle() {
    module_.power_cycle();
    wait(one_millisecond);
  }

  void wait(Microseconds duration) { module_.advance_to(module_.now() + duration); }

 private:
  TestPort port_;
  VirtualModule module_;
};

std::string describe(const Expectation& expected) {
  std::ostringstream text;
  if (!expected.is_answered) return "no reply";
  text << "status " << int{expected.status} << ", value " << expected.lowest;
  if (expected.highest != expected.lowest) text << " to " << expected.highest;
  text << ", host " << int{expected.host_address} << ", module " << int{expected.module_address};
  return text.str();
}

std::string describe(const std::vector<std::uint8_t>& bytes) {
  if (bytes.empty()) return "no reply";
  if (bytes.size() != datagram_size) return std::to_string(bytes.size()) + " bytes";
  Datagram datagram;
  std::copy_n(bytes.begin(), datagram_size, datagram.bytes);
  const Reply reply = decode_reply(datagram);
  std::ostringstream text;
  text << "status " << static_cast<int>(reply.status) << ", value " << reply.value << ", host " << int{bytes[0]}
       << ", module " << int{bytes[1]};
  if (!datagram.checksum_is_right()) text << ", wrong checksum";
  return text.str();
}

bool is_as_expected(const std::vector<std::uint8_t>& bytes, const Command& command, const Expectation& expected) {
  if (!expected.is_answered) return bytes.empty();
  if (bytes.size() != datagram_size) return false;
  Datagram datagram;
  std::copy_n(bytes.begin(), datagram_size, datagram.bytes);
  const Reply reply = decode_reply(datagram);
  return datagram.checksum_is_right() && bytes[0] == expected.host_address && bytes[1] == expected.module_address &&
         static_cast<std::uint8_t>(reply.status) == expected.status && reply.opcode == command.opcode &&
         reply.value >= expected.lowest && reply.value <= expected.highest;
}

/// Executes one command on both. @return how they differ, or nothing
std::optional<std::string> compare(Subject& subject, ReferenceModule& reference, const Step& step) {
  constexpr Microseconds longest_pause = 260 * one_millisecond;
  Command command = step.command;
  std::uint8_t address = reference.address();
  if (step.recipient == Step::Recipient::group) address = reference.group_address();
  if (step.recipient == Step::Recipient::nobody) {
    address = 254;
    while (address == reference.address() || address == reference.group_address()) --address;
  }
  // What CCO has captured is known from its reply alone.
  const bool is_answered = address == reference.address() && reference.answers_everything();
  if (command.opcode == ref_cco && !is_answered) command = {ref_gap, 1, 0, 0};

  const Expectation expected = reference.request(address, command);
  const auto pause = static_cast<Microseconds>(reference.telegram_pause()) * one_millisecond;
  const auto bytes = subject.exchange(address, command, expected.is_answered ? longest_pause : pause);
  if (!is_as_expected(bytes, command, expected)) {
    return "expected: " + describe(expected) + "\nfound:    " + describe(bytes);
  }
  if (expected.is_answered) {
    Datagram datagram;
    std::copy_n(bytes.begin(), datagram_size, datagram.bytes);
    reference.observe(decode_reply(datagram).value);
  }
  return std::nullopt;
}

}  // namespace

std::string mnemonic(const Step& step) {
  switch (step.kind) {
    case Step::Kind::power_cycle:
      return "(power off and on)";
    case Step::Kind::software_reset:
      return "(command 255)";
    case Step::Kind::factory_reset:
      return "(command 137)";
    case Step::Kind::command:
      break;
  }
  const Command& command = step.command;
  const auto* const name =
      std::find_if(std::begin(names), std::end(names), [&](const Name& each) { return each.opcode == command.opcode; });
  std::ostringstream text;
  if (command.opcode == ref_calc) {
    text << "CALC LOAD, " << command.value;
  } else {
    text << name->text << ' ' << int{command.type} << ", " << int{command.motor} << ", " << command.value;
  }
  if (step.recipient == Step::Recipient::group) text << "   (to the secondary address)";
  if (step.recipient == Step::Recipient::nobody) text << "   (to another address)";
  return text.str();
}

std::string mnemonics(const Stream& stream) {
  std::string text;
  for (const Step& step : stream) text += mnemonic(step) + '\n';
  return text;
}

Stream random_stream(ModuleId module, std::size_t length, std::mt19937_64& random) {
  Dice dice(random);
  Stream stream(length);
  for (Step& step : stream) {
    step.command = random_command(module, dice);
    if (dice.once_in(40)) step.recipient = Step::Recipient::group;
    if (dice.once_in(60)) step.recipient = Step::Recipient::nobody;
    if (dice.once_in(300)) {
      constexpr Step::Kind kinds[] = {Step::Kind::power_cycle, Step::Kind::power_cycle, Step::Kind::power_cycle,
                                      Step::Kind::software_reset, Step::Kind::factory_reset};
      step.kind = kinds[dice.below(std::size(kinds))];
    }
  }
  return stream;
}

std::optional<Difference> find_difference(ModuleId module, const Stream& stream) {
  constexpr Microseconds patience = 260 * one_millisecond;
  Subject subject(module);
  ReferenceModule reference(module);
  for (std::size_t i = 0; i < stream.size(); ++i) {
    const Step& step = stream[i];
    switch (step.kind) {
      case Step::Kind::command:
        if (const auto text = compare(subject, reference, step)) return Difference{i, *text};
        break;
      case Step::Kind::power_cycle:
        subject.settle();
        subject.power_cycle();
        reference.restart();
        break;
      case Step::Kind::software_reset: {
        const auto bytes = subject.exchange(reference.address(), {software_reset_opcode, 0, 0, confirmation}, patience);
        if (bytes.empty() == reference.answers_everything()) return Difference{i, "found: " + describe(bytes)};
        subject.settle();
        reference.restart();
        break;
      }
      case Step::Kind::factory_reset:
        if (reference.refuses_factory_reset()) break;
        subject.exchange(reference.address(), {factory_reset_opcode, 0, 0, confirmation}, 0);
        subject.settle();
        reference.restore_factory_settings();
        break;
    }
    // Global parameter 64 restores the factory settings in the start that follows.
    if (step.kind != Step::Kind::command) subject.settle();
  }
  return std::nullopt;
}

Stream shortest_with_difference(ModuleId module, Stream stream) {
  const auto cut_behind_difference = [module](Stream& candidate) {
    const auto difference = find_difference(module, candidate);
    if (difference) candidate.resize(difference->step + 1);
    return difference.has_value();
  };
  if (!cut_behind_difference(stream)) return stream;
  // Ever smaller pieces are left out as long as that leaves a difference.
  for (std::size_t piece = std::max<std::size_t>(1, stream.size() / 2); piece > 0; piece /= 2) {
    for (std::size_t end = stream.size(); end > 0;) {
      const std::size_t begin = end > piece ? end - piece : 0;
      Stream candidate = stream;
      candidate.erase(candidate.begin() + static_cast<std::ptrdiff_t>(begin),
                      candidate.begin() + static_cast<std::ptrdiff_t>(end));
      if (cut_behind_difference(candidate)) stream = candidate;
      end = std::min(begin, stream.size());
    }
  }
  return stream;
}

}  // namespace opentmcl::tests
