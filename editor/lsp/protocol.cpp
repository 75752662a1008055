#include "editor/lsp/protocol.hpp"

#include <cstddef>
#include <cstdint>
#include <utility>

namespace opentmcl::editor::lsp {

namespace {

std::optional<std::size_t> count_of(const json& value) {
  if (!value.is_number_integer() || (!value.is_number_unsigned() && value.get<std::int64_t>() < 0)) return std::nullopt;
  return value.get<std::size_t>();
}

}  // namespace

const json& member(const json& object, const char* name) {
  static const json none;
  const auto found = object.find(name);  // end for what is no object
  return found == object.end() ? none : *found;
}

const json& member(const json& object, const char* name, const char* inner_name) {
  return member(member(object, name), inner_name);
}

std::optional<std::string> text_of(const json& value) {
  if (!value.is_string()) return std::nullopt;
  return value.get_ref<const std::string&>();
}

std::optional<Position> position_of(const json& value) {
  const std::optional<std::size_t> line = count_of(member(value, "line"));
  const std::optional<std::size_t> character = count_of(member(value, "character"));
  if (!line || !character) return std::nullopt;
  return Position{*line, *character};
}

std::optional<Range> range_of(const json& value) {
  const std::optional<Position> start = position_of(member(value, "start"));
  const std::optional<Position> end = position_of(member(value, "end"));
  if (!start || !end) return std::nullopt;
  return Range{*start, *end};
}

json to_json(Position position) {
  return {{"line", position.line}, {"character", position.character}};
}

json range_json(const TextIndex& index, std::size_t offset, std::size_t length) {
  json start = to_json(index.position_of(offset));
  return {{"start", std::move(start)}, {"end", to_json(index.position_of(offset + length))}};
}

json text_edit(json range, std::string text) {
  return {{"range", std::move(range)}, {"newText", std::move(text)}};
}

}  // namespace opentmcl::editor::lsp
