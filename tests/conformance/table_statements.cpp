#include "tests/conformance/table_statements.hpp"

#include <algorithm>
#include <cctype>
#include <stdexcept>

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
      others += number + " 0 0 0 -> 2\n";
    }
  }
  statements.push_back(
      usb_statement("no-other-command", "3.5", "No other command exists.", Modules::both, std::move(others)));

  for (const TableRow& row : rows) {
    const Modules modules = modules_named(row["modules"]);
    const std::string id = "command-" + row["number"];
    const std::string request = row["number"] + " 0 0 0 -> ";
    if (!row["reply"].empty()) {
      statements.push_back(usb_statement(id, row["overview"], row["name"] + " is command " + row["number"] + '.',
                                         modules, request + row["reply"]));
    }
    if (const Modules lacking = without(Modules::both, modules); lacking != Modules::none) {
      statements.push_back(
          usb_statement(id + "-absent", row["overview"], row["name"] + " does not exist.", lacking, request + '2'));
    }
  }
  return statements;
}

Statements interrupt_statements(const std::vector<TableRow>& rows) {
  Statements statements;
  for (const TableRow& row : rows) {
    const std::string& number = row["number"];
    const std::string id = "interrupt-" + number;
    const Modules modules = modules_named(row["modules"]);
    std::string steps = "EI " + number + " -> 100\nDI " + number + " -> 100\n";
    if (number != "255") steps = "VECT " + number + ", 0 -> 100\n" + steps;
    statements.push_back(
        usb_statement(id, "3.6.6.1", "Interrupt " + number + " is " + row["name"] + '.', modules, steps));
    const std::string set = "SGP " + number + ", 3, ";
    const std::string get = "GGP " + number + ", 3 -> 100, ";
    if (row["setting"] == "period") {
      statements.push_back(usb_statement(
          id + "-setting", "5.4", "Bank 3 holds the period of " + row["name"] + " in ms, 32 bits unsigned.", modules,
          get + "0\n" + set + "1000 -> 100\n" + get + "1000\n" + set + "-1 -> 100\n" + get + "-1\n"));
    } else if (row["setting"] == "edge") {
      std::string setting = get + "0\n";
      for (const char* value : {"0", "1", "2", "3"}) setting += set + value + " -> 100\n" + get + value + '\n';
      statements.push_back(usb_statement(id + "-setting", "5.4",
                                         "Bank 3 holds the edges of " + row["name"] + ", 0 to 3.", modules,
                                         setting + set + "4 -> 4\n" + set + "-1 -> 4\n" + get + "3\n"));
    } else {
      statements.push_back(usb_statement(id + "-setting", "5.4", "Bank 3 holds nothing for " + row["name"] + '.',
                                         modules, set + "1 -> 3\nGGP " + number + ", 3 -> 3\n"));
    }
    if (const Modules lacking = without(Modules::both, modules); lacking != Modules::none) {
      statements.push_back(usb_statement(id + "-absent", "3.6.6.1", "Interrupt " + number + " does not exist.", lacking,
                                         "VECT " + number + ", 0 -> 3\nEI " + number + " -> 3\nDI " + number +
                                             " -> 3\n" + set + "1 -> 3\nGGP " + number + ", 3 -> 3\n"));
    }
  }
  return statements;
}

Statements io_port_statements(const std::vector<TableRow>& rows) {
  Statements statements;
  for (const TableRow& row : rows) {
    const std::string port = row["port"] + ", " + row["bank"];
    const std::string get = "GIO " + port + " -> 100, ";
    std::string steps;
    if (row["bench"].empty()) {
      steps = "GIO " + port + " -> 100\n";
    } else if (row["bank"] == "2") {
      for (const char* level : {"1", "0"}) {
        steps +=
            "SIO " + port + ", " + level + " -> 100\n" + get + level + "\ncheck " + row["bench"] + " = " + level + '\n';
      }
      steps += "SIO " + port + ", 2 -> 4\n";
    } else {
      for (const char* value : {"0", "1"}) steps += "set " + row["bench"] + " = " + value + '\n' + get + value + '\n';
      if (row["bank"] == "1") steps += "set " + row["bench"] + " = 4095\n" + get + "4095\n";
    }
    std::string name = row["name"];
    const bool is_decided = name.back() == '?';
    if (is_decided) name.pop_back();
    const Modules modules = modules_named(row["modules"]);
    const std::string id = "io-port-" + row["bank"] + '-' + row["port"];
    const char* const section = row["bank"] == "2" ? "3.7.14 3.7.15 TM-6.2" : "3.7.15 TM-6.2";
    Statement statement = usb_statement(id, section, "Port " + port + " is " + name + '.', modules, steps);
    if (is_decided) statement.decision = "0005";
    statements.push_back(std::move(statement));
    if (const Modules lacking = without(Modules::both, modules); lacking != Modules::none) {
      statements.push_back(usb_statement(id + "-absent", section, "Port " + port + " does not exist.", lacking,
                                         "GIO " + port + " -> 3\n"));
    }
  }
  return statements;
}

Statements datagram_statements() {
  Statements statements;
  for (const tests::ManualDatagram& row : tests::manual_datagrams) {
    const Command command = decode_request(row.request).command;
    const auto is_of = [](const std::string& section, const char* manual) { return section.rfind(manual, 0) == 0; };
    std::string section = row.section;
    section = (is_of(section, "S1") ? "TM-" : "") + section.substr(section.find(' ') + 1);
    const std::string name = row.mnemonic != nullptr ? row.mnemonic : "command " + std::to_string(command.opcode);
    std::string value;
    std::string before;
    if (row.reply) {
      value = ", " + std::to_string(decode_reply(*row.reply).value);
      if (command.opcode == static_cast<std::uint8_t>(Opcode::gio)) {
        before = "set analog 0 =" + value.substr(1) + '\n';
      }
    }
    statements.push_back(usb_statement("datagram-" + as_id(section) + '-' + as_id(name), section,
                                       "The datagram of " + name + " is answered.", row.modules,
                                       before + std::to_string(command.opcode) + ' ' + std::to_string(command.type) +
                                           ' ' + std::to_string(command.motor) + ' ' + std::to_string(command.value) +
                                           " -> " + std::to_string(static_cast<int>(row.status)) + value + '\n'));
  }
  return statements;
}

}  // namespace opentmcl::conformance
