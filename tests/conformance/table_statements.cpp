#include "tests/conformance/table_statements.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <utility>

#include "firmware/spec/instructions.hpp"
#include "tests/manual_datagrams/manual_datagrams.hpp"

namespace opentmcl::conformance {

namespace {

constexpr Modules without(Modules all, Modules some) {
  return static_cast<Modules>(static_cast<unsigned>(all) & ~static_cast<unsigned>(some));
}

/// Letters and digits of `text` in lower case, with one dash for whatever is between them.
std::string as_id(const std::string& text) {
  std::string id;
  for (const char character : text) {
    if (std::isalnum(static_cast<unsigned char>(character)) != 0) {
      id += static_cast<char>(std::tolower(static_cast<unsigned char>(character)));
    } else if (!id.empty() && id.back() != '-') {
      id += '-';
    }
  }
  if (!id.empty() && id.back() == '-') id.pop_back();
  return id;
}

Statement usb_statement(std::string id, std::string section, std::string says, Modules modules, std::string steps) {
  return {std::move(id), std::move(section), std::move(says), modules, hal::PortKind::usb, "", "", std::move(steps)};
}

}  // namespace

Statements command_statements(const std::vector<TableRow>& rows) {
  Statements statements;
  std::string others;
  for (int opcode = 0; opcode < 256; ++opcode) {
    const std::string number = std::to_string(opcode);
    if (std::none_of(rows.begin(), rows.end(), [&number](const TableRow& row) { return row["number"] == number; })) {
      others += fmt::format("{} 0 0 0 -> 2\n", number);
    }
  }
  statements.push_back(
      usb_statement("no-other-command", "3.5", "No other command exists.", Modules::both, std::move(others)));

  for (const TableRow& row : rows) {
    const Modules modules = modules_named(row["modules"]);
    const std::string& number = row["number"];
    if (!row["reply"].empty()) {
      statements.push_back(usb_statement(fmt::format("command-{}", number), row["overview"],
                                         fmt::format("{} is command {}.", row["name"], number), modules,
                                         fmt::format("{} 0 0 0 -> {}", number, row["reply"])));
    }
    if (const Modules lacking = without(Modules::both, modules); lacking != Modules::none) {
      statements.push_back(usb_statement(fmt::format("command-{}-absent", number), row["overview"],
                                         fmt::format("{} does not exist.", row["name"]), lacking,
                                         fmt::format("{} 0 0 0 -> 2", number)));
    }
  }
  return statements;
}

namespace {

/// What bank 3 holds for an interrupt: sentence and steps.
std::pair<std::string, std::string> setting_of(const TableRow& row) {
  const std::string set = fmt::format("SGP {}, 3, ", row["number"]);
  const std::string get = fmt::format("GGP {}, 3 -> 100, ", row["number"]);
  if (row["setting"] == "period") {
    return {fmt::format("Bank 3 holds the period of {} in ms, 32 bits unsigned.", row["name"]),
            fmt::format("{1}0\n{0}1000 -> 100\n{1}1000\n{0}-1 -> 100\n{1}-1\n", set, get)};
  }
  if (row["setting"] == "edge") {
    std::string steps = get + "0\n";
    for (const int edges : {0, 1, 2, 3}) steps += fmt::format("{0}{2} -> 100\n{1}{2}\n", set, get, edges);
    return {fmt::format("Bank 3 holds the edges of {}, 0 to 3.", row["name"]),
            fmt::format("{2}{0}4 -> 4\n{0}-1 -> 4\n{1}3\n", set, get, steps)};
  }
  return {fmt::format("Bank 3 holds nothing for {}.", row["name"]),
          fmt::format("{}1 -> 3\nGGP {}, 3 -> 3\n", set, row["number"])};
}

}  // namespace

Statements interrupt_statements(const std::vector<TableRow>& rows) {
  constexpr const char* global_interrupt = "255";  // has no vector
  Statements statements;
  for (const TableRow& row : rows) {
    const std::string& number = row["number"];
    const Modules modules = modules_named(row["modules"]);
    const std::string vector = number == global_interrupt ? "" : fmt::format("VECT {}, 0 -> 100\n", number);
    statements.push_back(usb_statement(fmt::format("interrupt-{}", number), "3.6.6.1",
                                       fmt::format("Interrupt {} is {}.", number, row["name"]), modules,
                                       fmt::format("{1}EI {0} -> 100\nDI {0} -> 100\n", number, vector)));
    auto [says, steps] = setting_of(row);
    statements.push_back(
        usb_statement(fmt::format("interrupt-{}-setting", number), "5.4", std::move(says), modules, std::move(steps)));
    if (const Modules lacking = without(Modules::both, modules); lacking != Modules::none) {
      statements.push_back(usb_statement(
          fmt::format("interrupt-{}-absent", number), "3.6.6.1", fmt::format("Interrupt {} does not exist.", number),
          lacking,
          fmt::format("VECT {0}, 0 -> 3\nEI {0} -> 3\nDI {0} -> 3\nSGP {0}, 3, 1 -> 3\nGGP {0}, 3 -> 3\n", number)));
    }
  }
  return statements;
}

namespace {

/// Steps that try one port, "port, bank".
std::string steps_for_port(const std::string& port, const TableRow& row) {
  const std::string& bench = row["bench"];
  if (bench.empty()) return fmt::format("GIO {} -> 100\n", port);
  if (row["bank"] == "2") {
    return fmt::format(
        "SIO {0}, 1 -> 100\nGIO {0} -> 100, 1\ncheck {1} = 1\n"
        "SIO {0}, 0 -> 100\nGIO {0} -> 100, 0\ncheck {1} = 0\nSIO {0}, 2 -> 4\n",
        port, bench);
  }
  const int highest = row["bank"] == "1" ? 4095 : 1;
  return fmt::format("set {1} = 0\nGIO {0} -> 100, 0\nset {1} = {2}\nGIO {0} -> 100, {2}\n", port, bench, highest);
}

}  // namespace

Statements io_port_statements(const std::vector<TableRow>& rows) {
  Statements statements;
  for (const TableRow& row : rows) {
    const std::string port = fmt::format("{}, {}", row["port"], row["bank"]);
    std::string name = row["name"];
    const bool is_decided = name.back() == '?';
    if (is_decided) name.pop_back();
    const Modules modules = modules_named(row["modules"]);
    const std::string id = fmt::format("io-port-{}-{}", row["bank"], row["port"]);
    const char* const section = row["bank"] == "2" ? "3.7.14 3.7.15 TM-6.2" : "3.7.15 TM-6.2";
    Statement statement =
        usb_statement(id, section, fmt::format("Port {} is {}.", port, name), modules, steps_for_port(port, row));
    if (is_decided) statement.decision = "0005";
    statements.push_back(std::move(statement));
    if (const Modules lacking = without(Modules::both, modules); lacking != Modules::none) {
      statements.push_back(usb_statement(fmt::format("{}-absent", id), section,
                                         fmt::format("Port {} does not exist.", port), lacking,
                                         fmt::format("GIO {} -> 3\n", port)));
    }
  }
  return statements;
}

namespace {

/// "S0 3.7.1" is section 3.7.1 of the PD-1161 manual, "S1 3.6.1" of that of the TMCM-1110.
std::string section_of(const tests::ManualDatagram& row) {
  const std::string place = row.section;
  return (place.rfind("S1", 0) == 0 ? "TM-" : "") + place.substr(place.find(' ') + 1);
}

Statement datagram_statement(const tests::ManualDatagram& row) {
  const Command command = decode_request(row.request).command;
  const std::string section = section_of(row);
  const std::string name =
      row.mnemonic != nullptr ? std::string(row.mnemonic) : fmt::format("command {}", command.opcode);
  std::string steps;
  std::string value;
  if (row.reply) {
    const std::int32_t reply_value = decode_reply(*row.reply).value;
    if (command.opcode == static_cast<std::uint8_t>(Opcode::gio)) {
      steps = fmt::format("set analog 0 = {}\n", reply_value);
    }
    value = fmt::format(", {}", reply_value);
  }
  steps += fmt::format("{} {} {} {} -> {}{}\n", command.opcode, command.type, command.motor, command.value,
                       static_cast<int>(row.status), value);
  return usb_statement(fmt::format("datagram-{}-{}", as_id(section), as_id(name)), section,
                       fmt::format("The datagram of {} is answered.", name), row.modules, std::move(steps));
}

}  // namespace

Statements datagram_statements() {
  Statements statements;
  for (const tests::ManualDatagram& row : tests::manual_datagrams) statements.push_back(datagram_statement(row));
  return statements;
}

}  // namespace opentmcl::conformance
