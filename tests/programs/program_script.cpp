#include "tests/programs/program_script.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <regex>
#include <sstream>

namespace opentmcl::tests {

namespace {

// A line is a part of the script when it begins with one of its words; then it has to be right as a whole.
const std::regex script_line(R"(\s*//\s*(module|run|expect|at)\b(.*?)\s*)");
const std::regex module_line(R"(\s*:\s*(tmcm1110|pd1161))");
const std::regex run_line(R"(\s*:\s*([\d.]+ m?s))");
const std::regex setting_line(R"(\s+([\d.]+ m?s)\s*:\s*(.+?)\s*=\s*(\S+))");
const std::regex expectation_line(R"(\s*:\s*(.+?)\s*=\s*(\S+)(?:\s+\+-\s+(\d+))?(?:\s+(at|within)\s+([\d.]+ m?s))?)");
const std::regex quantity_words(R"(([a-z]+(?: [a-z]+)*)(?: (\d+))?)");
const std::regex whole_number(R"(-?\d+)");

std::int32_t number_from(const std::string& text) {
  return static_cast<std::int32_t>(std::stoll(text));
}

Microseconds time_from(const std::string& text) {
  const double number = std::stod(text);
  const bool is_milliseconds = text.ends_with("ms");
  return static_cast<Microseconds>(std::llround(number * (is_milliseconds ? 1'000 : 1'000'000)));
}

std::optional<std::int32_t> value_from(const std::string& text) {
  static const std::map<std::string, std::int32_t> words = {{"low", 0}, {"high", 1}, {"stopped", 0}, {"running", 1}};
  if (const auto word = words.find(text); word != words.end()) return word->second;
  if (std::regex_match(text, whole_number)) return number_from(text);
  return std::nullopt;
}

std::optional<Quantity> quantity_from(const std::string& text) {
  std::smatch parts;
  if (!std::regex_match(text, parts, quantity_words)) return std::nullopt;
  Quantity quantity{parts[1], std::nullopt};
  if (parts[2].matched) quantity.number = static_cast<std::uint8_t>(std::stoi(parts[2]));
  return quantity;
}

class Parser {
 public:
  ProgramScript parse(std::string_view source) {
    std::istringstream lines{std::string(source)};
    std::string line;
    for (line_ = 1; std::getline(lines, line); ++line_) {
      std::smatch parts;
      if (!std::regex_match(line, parts, script_line)) continue;
      if (!take(parts[1], parts[2])) script_.errors.push_back(std::to_string(line_) + ": " + line);
    }
    if (script_.modules.empty()) script_.modules = {ModuleId::tmcm1110, ModuleId::pd1161};
    std::stable_sort(script_.settings.begin(), script_.settings.end(),
                     [](const Setting& a, const Setting& b) { return a.time < b.time; });
    return script_;
  }

 private:
  /// @return whether the line is right
  bool take(const std::string& word, const std::string& rest) {
    std::smatch parts;
    if (word == "module") {
      if (!std::regex_match(rest, parts, module_line)) return false;
      script_.modules.push_back(parts[1] == "pd1161" ? ModuleId::pd1161 : ModuleId::tmcm1110);
      return true;
    }
    if (word == "run") {
      if (!std::regex_match(rest, parts, run_line)) return false;
      script_.run_time = time_from(parts[1]);
      return true;
    }
    if (word == "at") {
      if (!std::regex_match(rest, parts, setting_line)) return false;
      const auto quantity = quantity_from(parts[2]);
      const auto value = value_from(parts[3]);
      if (quantity && value) script_.settings.push_back({line_, time_from(parts[1]), *quantity, *value});
      return quantity && value;
    }
    if (!std::regex_match(rest, parts, expectation_line)) return false;
    const auto quantity = quantity_from(parts[1]);
    const auto value = value_from(parts[2]);
    if (!quantity || !value) return false;
    Expectation expectation{line_, rest, *quantity, *value};
    if (parts[3].matched) expectation.tolerance = number_from(parts[3]);
    if (parts[4].matched) {
      expectation.when = parts[4] == "at" ? Expectation::When::at : Expectation::When::within;
      expectation.time = time_from(parts[5]);
    }
    script_.expectations.push_back(expectation);
    return true;
  }

  ProgramScript script_;
  int line_ = 0;
};

}  // namespace

ProgramScript parse_script(std::string_view source) {
  return Parser().parse(source);
}

}  // namespace opentmcl::tests
