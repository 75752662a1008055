#include "apps/tmcl/assembly_json.hpp"

#include <map>

#include "lang/diagnostic_kind.hpp"

namespace opentmcl::app {

using Json = nlohmann::ordered_json;

namespace {

/// Lines and columns of places in several files.
class Places {
 public:
  explicit Places(const lang::Sources& sources) : sources_(&sources) {}

  lang::Position position(lang::FileId file, std::size_t offset) {
    auto lines = lines_.find(file);
    if (lines == lines_.end()) lines = lines_.emplace(file, lang::LineIndex((*sources_)[file].text)).first;
    return lines->second.position_of(offset);
  }

  Json json_of(lang::Span span) {
    const lang::Position begin = position(span.file, span.offset);
    const lang::Position end = position(span.file, span.offset + span.length);
    return {{"file", lang::to_utf8((*sources_)[span.file].name)},
            {"line", begin.line},
            {"column", begin.column},
            {"end_line", end.line},
            {"end_column", end.column}};
  }

 private:
  const lang::Sources* sources_;
  std::map<lang::FileId, lang::LineIndex> lines_;
};

const char* name_of(lang::Severity severity) {
  return severity == lang::Severity::error ? "error" : "warning";
}

Json json_of(const lang::Diagnostic& diagnostic, Places& places) {
  Json json{{"name", lang::name_of(diagnostic.kind)},
            {"severity", name_of(diagnostic.severity())},
            {"message", diagnostic.message},
            {"place", places.json_of(diagnostic.span)}};
  if (!diagnostic.note.empty()) json["note"] = diagnostic.note;
  if (diagnostic.related) json["related"] = places.json_of(*diagnostic.related);
  if (diagnostic.fix) {
    json["fix"] = {{"title", diagnostic.fix->title},
                   {"place", places.json_of(diagnostic.fix->span)},
                   {"replacement", diagnostic.fix->replacement}};
  }
  return json;
}

}  // namespace

Json diagnostics_as_json(const std::vector<lang::Diagnostic>& diagnostics, const lang::Sources& sources) {
  Places places(sources);
  Json array = Json::array();
  for (const lang::Diagnostic& diagnostic : diagnostics) array.push_back(json_of(diagnostic, places));
  return array;
}

Json warnings_as_json() {
  Json array = Json::array();
  for (const lang::DiagnosticKindSpec& row : lang::diagnostic_kinds) {
    if (row.severity == lang::Severity::warning) array.push_back({{"name", row.name}, {"summary", row.summary}});
  }
  return array;
}

std::string source_map_as_json(const lang::Program& program, const lang::Sources& sources,
                               const ModuleDescription& module) {
  Places places(sources);
  Json files = Json::array();
  for (lang::FileId file = 0; file < sources.size(); ++file) files.push_back(lang::to_utf8(sources[file].name));
  Json instructions = Json::array();
  for (std::size_t address = 0; address < program.source_map.size(); ++address) {
    const lang::Span span = program.source_map[address];
    if (span.length == 0) continue;  // the STOP that was appended
    const lang::Position begin = places.position(span.file, span.offset);
    const lang::Position end = places.position(span.file, span.offset + span.length);
    instructions.push_back({{"address", address},
                            {"file", span.file},
                            {"line", begin.line},
                            {"column", begin.column},
                            {"length", end.column - begin.column}});
  }
  return Json{{"version", 1},
              {"module", module.argument},
              {"instruction_count", program.commands.size()},
              {"files", files},
              {"instructions", instructions}}
             .dump(1) +
         "\n";
}

}  // namespace opentmcl::app
