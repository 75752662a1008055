#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

#include "tests/conformance/table_statements.hpp"

namespace opentmcl::conformance {

namespace {

constexpr const char* accumulator_is = "135 2 0 0 -> 100, ";
constexpr const char* x_register_is = "135 3 0 0 -> 100, ";

/// Where an operand of a calculation is.
enum class Place { accumulator, x_register, first_variable, second_variable, value };

struct Calculation {
  const char* command;
  Place left;
  Place right;
  const char* operands;  ///< behind the operation
};

constexpr Calculation calculations[] = {
    {"CALC", Place::accumulator, Place::value, ", "},
    {"CALCX", Place::accumulator, Place::x_register, ""},
    {"CALCVV", Place::first_variable, Place::second_variable, ", 10, 11"},
    {"CALCVA", Place::first_variable, Place::accumulator, ", 10"},
    {"CALCAV", Place::accumulator, Place::second_variable, ", 11"},
    {"CALCVX", Place::first_variable, Place::x_register, ", 10"},
    {"CALCXV", Place::x_register, Place::second_variable, ", 11"},
    {"CALCV", Place::first_variable, Place::value, ", 10, "},
};

/// Instructions that put a value there. X is loaded through the accumulator, so it must be loaded first.
std::vector<std::string> loading(Place place, const std::string& value) {
  switch (place) {
    case Place::accumulator:
      return {"CALC LOAD, " + value};
    case Place::x_register:
      return {"CALC LOAD, " + value, "CALCX LOAD"};
    case Place::first_variable:
      return {"SGP 10, 2, " + value};
    case Place::second_variable:
      return {"SGP 11, 2, " + value};
    case Place::value:
      break;
  }
  return {};
}

std::string reading(Place place, const std::string& value) {
  switch (place) {
    case Place::accumulator:
      return accumulator_is + value + '\n';
    case Place::x_register:
      return x_register_is + value + '\n';
    case Place::first_variable:
      return "GGP 10, 2 -> 100, " + value + '\n';
    case Place::second_variable:
      return "GGP 11, 2 -> 100, " + value + '\n';
    case Place::value:
      break;
  }
  return {};
}

std::string in_lower_case(std::string text) {
  std::transform(text.begin(), text.end(), text.begin(), [](char character) {
    return character >= 'A' && character <= 'Z' ? static_cast<char>(character + 32) : character;
  });
  return text;
}

/// A program that jumps when `condition` holds after `before` and then leaves 2 in variable 0, else 1.
std::string branching(const std::string& before, const std::string& condition) {
  return before + "JC " + condition + ", Taken\nSGP 0, 2, 1\nSTOP\nTaken: SGP 0, 2, 2\nSTOP\n";
}

std::string run_and_expect(const char* result) {
  return std::string("run\nuntil GGP 128, 0 = 0 within 1 s\nGGP 0, 2 -> 100, ") + result + '\n';
}

/// All lines, each with `ending` behind it.
std::string joined(const std::vector<std::string>& lines, const char* ending) {
  std::string text;
  for (const std::string& line : lines) text.append(line).append(ending);
  return text;
}

Statement calculation_statement(const TableRow& row) {
  const std::string& command = row["command"];
  const std::string& operation = row["operation"];
  const auto* const calculation =
      std::find_if(std::begin(calculations), std::end(calculations),
                   [&command](const Calculation& candidate) { return command == candidate.command; });
  if (calculation == std::end(calculations)) throw std::runtime_error("no calculation is called " + command);

  std::vector<std::string> instructions = loading(calculation->right, row["right"]);
  for (std::string& line : loading(calculation->left, row["left"])) instructions.push_back(std::move(line));
  if (calculation->left == Place::x_register) {
    std::rotate(instructions.begin(), instructions.end() - 2, instructions.end());
  }
  const std::string value = calculation->right == Place::value ? row["right"] : "";
  instructions.push_back(fmt::format("{} {}{}{}", command, operation, calculation->operands, value));

  Statement statement;
  statement.id = in_lower_case(fmt::format("{}-{}", command, operation));
  statement.section = row["section"];
  statement.modules = modules_named(row["modules"]);
  if (operation == "COMP") {
    statement.says = command + " COMP compares and sets the flags.";
    statement.program = branching(joined(instructions, "\n"), row["left_after"]);
    statement.steps = run_and_expect("2") + reading(calculation->left, row["left"]);
  } else {
    statement.says =
        fmt::format("{} {} makes {} of {} and {}.", command, operation, row["left_after"], row["left"], row["right"]);
    statement.steps = joined(instructions, " -> 100\n") + reading(calculation->left, row["left_after"]) +
                      reading(calculation->right, row["right_after"]);
  }
  return statement;
}

/// What JC and CALL have in common. @param verb "Jump" or "Call"
Statement condition_statement(const char* instruction, const char* verb, const std::string& condition, bool holds) {
  Statement statement;
  statement.id = in_lower_case(fmt::format("{}-{}-{}", instruction, condition, holds ? "holds" : "fails"));
  statement.says = holds ? fmt::format("{}s on {} if it holds.", verb, condition)
                         : fmt::format("Does not {} on {} if it does not hold.", in_lower_case(verb), condition);
  statement.steps = run_and_expect(holds ? "2" : "1");
  return statement;
}

/// @param before instructions, after which the condition holds or not
Statement jump_statement(const std::string& condition, const std::string& before, bool holds) {
  Statement statement = condition_statement("jc", "Jump", condition, holds);
  statement.section = "3.7.18";
  statement.program = branching(before, condition);
  return statement;
}

/// @param before instructions, after which the condition holds or not
Statement call_statement(const std::string& condition, const std::string& before, bool holds) {
  Statement statement = condition_statement("call", "Call", condition, holds);
  statement.section = "3.7.44";
  statement.modules = Modules::pd1161;
  statement.program = fmt::format("{}SGP 0, 2, 1\nCALL {}, Called\nCALCV ADD, 1, 10\nSTOP\nCalled: SGP 0, 2, 2\nRSUB\n",
                                  before, condition);
  statement.steps += "GGP 1, 2 -> 100, 10\n";
  return statement;
}

}  // namespace

Statements calculation_statements(const std::vector<TableRow>& rows) {
  Statements statements;
  for (const TableRow& row : rows) statements.push_back(calculation_statement(row));
  return statements;
}

Statements condition_statements(const std::vector<TableRow>& rows) {
  Statements statements;
  for (const TableRow& row : rows) {
    for (const bool holds : {true, false}) {
      std::string before = row[holds ? "holds" : "fails"];
      if (before.empty()) continue;
      std::replace(before.begin(), before.end(), ';', '\n');
      before += '\n';
      statements.push_back(jump_statement(row["condition"], before, holds));
      statements.push_back(call_statement(row["condition"], before, holds));
    }
  }
  return statements;
}

}  // namespace opentmcl::conformance
