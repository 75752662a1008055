#include "scenario/toml_place.hpp"

#include <algorithm>
#include <string>

namespace opentmcl::scenario {
namespace {

/// toml++ counts columns in characters, not bytes.
unsigned characters_in(std::string_view text) {
  constexpr unsigned char continuation_mask = 0xC0;
  constexpr unsigned char continuation = 0x80;
  return static_cast<unsigned>(std::count_if(text.begin(), text.end(), [](char byte) {
    return (static_cast<unsigned char>(byte) & continuation_mask) != continuation;
  }));
}

}  // namespace

Place place_of(const toml::source_region& region) {
  return {region.begin.line, region.begin.column};
}

Place place_of(const toml::node& node) {
  return place_of(node.source());
}

Place place_within(const toml::node& node, std::size_t offset) {
  const toml::source_region& region = node.source();
  const std::string content = node.value_exact<std::string>().value_or("");
  constexpr unsigned quotes = 2;
  const bool one_line = region.begin.line == region.end.line;
  const bool is_plain = region.end.column - region.begin.column == characters_in(content) + quotes;
  if (!one_line || !is_plain) return place_of(node);
  return {region.begin.line, region.begin.column + 1 + characters_in(std::string_view(content).substr(0, offset))};
}

std::string description_of(const toml::parse_error& error) {
  const std::string_view description = error.description();
  // All that toml++ knows of a missing quote is that the text has gone on to the end of the line.
  if (description.find("unescaped control characters") == std::string_view::npos) return std::string(description);
  return "the text does not end in its line: expected a quote";
}

std::string_view kind_of(const toml::node& node) {
  switch (node.type()) {
    case toml::node_type::table:
      return "a table";
    case toml::node_type::array:
      return "an array";
    case toml::node_type::string:
      return "a text";
    case toml::node_type::integer:
    case toml::node_type::floating_point:
      return "a number";
    case toml::node_type::boolean:
      return "true or false";
    default:
      return "a date or time";
  }
}

}  // namespace opentmcl::scenario
