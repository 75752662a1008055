#include "editor/dap/program_sources.hpp"

#include <filesystem>
#include <system_error>

#include "lang/source.hpp"

namespace opentmcl::editor::dap {

using client::Result;

namespace {

/// References count from 1: 0 means that there is none.
std::int64_t reference_of(lang::FileId file) {
  return std::int64_t{file} + 1;
}

}  // namespace

std::string canonical_path(const std::string& path) {
  std::error_code error;
  const std::filesystem::path canonical = std::filesystem::weakly_canonical(path, error);
  return error ? path : canonical.string();
}

ProgramSources::ProgramSources(const debug::Program& program) : program_(program) {
  for (lang::FileId file = 0; file < program.file_count(); ++file) {
    std::error_code error;
    const bool is_on_disk = std::filesystem::is_regular_file(program.file_name(file), error);
    paths_.push_back(is_on_disk ? canonical_path(program.file_name(file)) : std::string());
  }
}

json ProgramSources::source(lang::FileId file) const {
  json source{{"name", std::filesystem::path(program_.file_name(file)).filename().string()}};
  if (!paths_[file].empty()) {
    source["path"] = paths_[file];
  } else {
    source["sourceReference"] = reference_of(file);
    source["origin"] = "not on the disk";
  }
  return source;
}

Result<lang::FileId> ProgramSources::find(const json& source) const {
  const Result<std::int64_t> reference = optional_integer(source, "sourceReference", 0);
  if (!reference) return reference.error();
  if (*reference > 0) {
    if (*reference > static_cast<std::int64_t>(paths_.size())) {
      return mistake("there is no source " + std::to_string(*reference));
    }
    return static_cast<lang::FileId>(*reference - 1);
  }
  const Result<std::string> path = required_text(source, "path");
  if (!path) return path.error();
  const std::string wanted = canonical_path(*path);
  for (lang::FileId file = 0; file < paths_.size(); ++file) {
    if (paths_[file] == wanted) return file;
  }
  return mistake(*path + " is no part of the program");
}

Result<std::string> ProgramSources::text(std::int64_t reference) const {
  const Result<lang::FileId> file = find(json{{"sourceReference", reference}});
  if (!file) return file.error();
  std::string text;
  for (std::size_t line = 1; line <= program_.line_count(*file); ++line) {
    text.append(lang::to_utf8(program_.line_text(*file, line))).append("\n");
  }
  return text;
}

json ProgramSources::all() const {
  json sources = json::array();
  for (lang::FileId file = 0; file < paths_.size(); ++file) sources.push_back(source(file));
  return sources;
}

void ProgramSources::put_place(json& object, std::uint16_t address, const ClientConventions& client) const {
  const std::optional<debug::Line> place = program_.line_of(address);
  if (!place) return;
  object["source"] = source(place->file);
  object["line"] = client.line(place->line);
  object["column"] = client.column(place->column);
}

}  // namespace opentmcl::editor::dap
