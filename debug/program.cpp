#include "debug/program.hpp"

#include <algorithm>
#include <utility>

#include "lang/disassembler.hpp"
#include "lang/file_provider.hpp"
#include "lang/names.hpp"

namespace opentmcl::debug {

Program::Program(lang::AssemblyResult assembled, const ModuleDescription& module)
    : program_(*std::move(assembled.program)),
      sources_(std::move(assembled.sources)),
      symbols_(std::move(assembled.symbols)),
      module_(&module) {
  for (lang::FileId file = 0; file < sources_.size(); ++file) indices_.emplace_back(sources_[file].text);
  for (std::size_t address = 0; address < size(); ++address) {
    if (program_.source_map[address].length > 0) by_place_.push_back(static_cast<std::uint16_t>(address));
  }
  std::stable_sort(by_place_.begin(), by_place_.end(), [this](std::uint16_t left, std::uint16_t right) {
    const lang::Span& a = program_.source_map[left];
    const lang::Span& b = program_.source_map[right];
    return a.file != b.file ? a.file < b.file : a.offset < b.offset;
  });
}

Program Program::disassembled(std::vector<Command> commands, const ModuleDescription& module, std::string_view name) {
  const lang::Disassembly source = lang::disassemble(commands, module);
  lang::MemoryFiles no_files;
  lang::AssemblerOptions options;
  options.module = &module;
  options.append_stop = false;
  lang::AssemblyResult assembled = lang::assemble(name, source.text, options, no_files);
  if (!assembled.program || assembled.program->commands != commands) {
    // Instructions that no source can express: they are shown by their numbers.
    lang::Program bare;
    bare.source_map.resize(commands.size());
    bare.commands = std::move(commands);
    assembled.program = std::move(bare);
  }
  return {std::move(assembled), module};
}

std::optional<lang::FileId> Program::find_file(std::string_view name) const {
  std::optional<lang::FileId> found;
  for (lang::FileId file = 0; file < file_count(); ++file) {
    const std::string_view whole = file_name(file);
    if (whole == name) return file;
    const bool ends_so =
        whole.size() > name.size() && whole.ends_with(name) && whole[whole.size() - name.size() - 1] == '/';
    if (!ends_so) continue;
    if (found) return std::nullopt;
    found = file;
  }
  return found;
}

std::optional<Line> Program::line_of(std::uint16_t address) const {
  if (address >= size()) return std::nullopt;
  const lang::Span& span = program_.source_map[address];
  if (span.length == 0) return std::nullopt;
  const lang::Position position = indices_[span.file].position_of(span.offset);
  return Line{span.file, position.line, position.column};
}

std::optional<std::uint16_t> Program::address_of(lang::FileId file, std::size_t line) const {
  if (file >= file_count() || line == 0 || line > line_count(file)) return std::nullopt;
  const std::size_t begin = indices_[file].start_of(line);
  const auto first = std::find_if(by_place_.begin(), by_place_.end(), [&](std::uint16_t address) {
    const lang::Span& span = program_.source_map[address];
    return span.file == file && span.offset >= begin;
  });
  if (first == by_place_.end()) return std::nullopt;
  return *first;
}

std::optional<std::uint16_t> Program::address_of_label(std::string_view name) const {
  for (const lang::Label& label : program_.labels) {
    if (lang::equal_ignoring_case(label.name, name)) return static_cast<std::uint16_t>(label.address);
  }
  return std::nullopt;
}

std::optional<double> Program::value_of_name(std::string_view name) const {
  const lang::Symbol* const symbol = symbols_.find(name);
  if (symbol == nullptr) return std::nullopt;
  return symbol->value;
}

Program::Place Program::place_of(std::uint16_t address) const {
  const auto behind =
      std::upper_bound(program_.labels.begin(), program_.labels.end(), address,
                       [](std::uint16_t place, const lang::Label& label) { return place < label.address; });
  if (behind == program_.labels.begin()) return {};
  const lang::Label& label = behind[-1];
  return {label.name, address - label.address};
}

std::string Program::name_of(std::uint16_t address) const {
  const Place place = place_of(address);
  if (place.label.empty()) return std::to_string(address);
  std::string name(place.label);
  if (place.offset > 0) name.append("+").append(std::to_string(place.offset));
  return name;
}

std::string Program::text_of(const Command& command) const {
  lang::DisassembledInstruction text = lang::disassemble_instruction(command, *module_);
  if (text.text) return *std::move(text.text);
  return "opcode " + std::to_string(command.opcode) + ", type " + std::to_string(command.type) + ", motor " +
         std::to_string(command.motor) + ", value " + std::to_string(command.value);
}

}  // namespace opentmcl::debug
