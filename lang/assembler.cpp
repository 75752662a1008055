#include "lang/assembler.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <utility>

#include "lang/encoder.hpp"
#include "lang/expression.hpp"
#include "lang/hexadecimal.hpp"
#include "lang/include_directive.hpp"
#include "lang/include_files.hpp"
#include "lang/include_search.hpp"
#include "lang/instruction_table.hpp"
#include "lang/lexer.hpp"
#include "lang/names.hpp"
#include "lang/program_check.hpp"
#include "lang/statement.hpp"
#include "lang/substitute.hpp"
#include "lang/suggestion.hpp"
#include "lang/switched_off.hpp"
#include "lang/text_encoding.hpp"

namespace opentmcl::lang {
namespace {

constexpr std::size_t maximum_include_depth = 32;
constexpr std::size_t maximum_files = 1000;

/// Guesses, which save large sources from growing their program and its names again and again.
constexpr std::size_t usual_line_length = 24;
constexpr std::size_t usual_length_per_symbol = 128;
constexpr std::size_t maximum_guess = 1U << 20;

/// An instruction that uses names which were not defined when it was read; it is encoded again at the end.
struct Fixup {
  std::uint32_t address;
  Span statement;
  std::uint32_t visible_constants;
};

/// A text the assembler reads, with its place among the sources.
struct Text {
  FileId file;
  std::string_view characters;

  Span span_of(const Token& token) const { return {file, token.offset, token.length}; }
  std::string_view of(const Token& token) const { return token.text(characters); }
};

std::string too_large_text() {
  return " is larger than " + std::to_string(maximum_text_size >> 20) + " MiB";
}

class Assembler {
 public:
  Assembler(const AssemblerOptions& options, FileProvider& files)
      : options_(&options),
        files_(&files),
        diagnostics_(options.switched_off),
        encoder_(*options.module, diagnostics_) {}

  AssemblyResult assemble(std::string_view file_name, std::string text) {
    if (text.size() > maximum_text_size) {
      sources_.add(std::string(file_name), "");
      diagnostics_.add(DiagnosticKind::file_too_large, {}, "the file" + too_large_text());
    } else {
      const std::size_t lines = std::min(text.size() / usual_line_length, maximum_guess);
      commands_.reserve(lines);
      source_map_.reserve(lines);
      symbols_.reserve(std::min(text.size() / usual_length_per_symbol, maximum_guess));
      read_text(sources_.add(std::string(file_name), std::move(text)));
      finish();
    }
    return result();
  }

  /// Defines the constants of the built-in files.
  void define_built_in_constants() {
    for (const char* name : {parameter_file_name, interrupt_file_name}) {
      read_text(sources_.add(name, *built_in_file(name, *options_->module), true));
    }
  }

  /// Reads an instruction that stands alone.
  InstructionResult assemble_instruction(std::string_view instruction) {
    const Text text = text_of(sources_.add("instruction", std::string(instruction)));
    Lexer lexer(text.characters);
    Statement statement;
    read_statement(lexer, statement);
    const bool is_alone = lexer.at_end() && statement.label_count == 0 && statement.kind != StatementKind::constant &&
                          statement.kind != StatementKind::directive && statement.kind != StatementKind::empty;
    if (is_alone) {
      handle(statement, text);
      finish_fixups();
    } else {
      const Span all{text.file, 0, static_cast<std::uint32_t>(text.characters.size())};
      diagnostics_.add(DiagnosticKind::not_one_instruction, all, "expected one instruction");
    }
    InstructionResult result;
    if (!diagnostics_.has_errors()) result.command = commands_.front();
    result.diagnostics = diagnostics_.take_sorted();
    result.sources = std::move(sources_);
    return result;
  }

 private:
  void read_text(FileId file) {
    const Text text = text_of(file);
    total_size_ += text.characters.size();
    if (is_utf16(text.characters)) return report_not_text({file, 0, 0}, "it is UTF-16: save it as UTF-8");
    open_files_.push_back(file);
    Lexer lexer(text.characters);
    Statement statement;
    while (!lexer.at_end()) {
      read_statement(lexer, statement);
      if (const std::optional<std::size_t> binary = find_binary(statement, text)) {
        const auto byte = static_cast<std::uint8_t>(text.characters[*binary]);
        report_not_text({file, static_cast<std::uint32_t>(*binary), 1},
                        "it has the byte " + hexadecimal(byte) + "h: is it a program that is assembled already?");
        break;
      }
      handle(statement, text);
    }
    open_files_.pop_back();
  }

  void handle(const Statement& statement, const Text& text) {
    for (std::size_t i = 0; i < statement.label_count; ++i) {
      const Token& label = statement.label(i);
      define({text.of(label), SymbolKind::label, static_cast<double>(commands_.size()), text.span_of(label)});
    }
    switch (statement.kind) {
      case StatementKind::empty:
        break;
      case StatementKind::instruction:
        add_instruction(statement, text);
        break;
      case StatementKind::constant:
        define_constant(statement, text);
        break;
      case StatementKind::directive:
        follow_directive(statement.name, text);
        break;
      case StatementKind::invalid_token:
        report_invalid(statement.name, text);
        break;
      case StatementKind::unexpected:
        diagnostics_.add(
            DiagnosticKind::expected_statement, text.span_of(statement.name),
            "expected an instruction, a label, a constant or #include, not " + in_quotes(text.of(statement.name)));
        break;
    }
  }

  /// Where a file turns out to be no text; nothing more is read of it then, because all of it would be an error.
  static std::optional<std::size_t> find_binary(const Statement& statement, const Text& text) {
    if (statement.kind != StatementKind::invalid_token) return std::nullopt;
    const Token& token = statement.name;
    if (token.kind != TokenKind::unexpected_character && token.kind != TokenKind::line_too_long) return std::nullopt;
    const auto found = find_control_character(text.of(token).substr(0, maximum_line_length));
    if (!found) return std::nullopt;
    return token.offset + *found;
  }

  void report_not_text(Span span, const std::string& reason) {
    diagnostics_.add(DiagnosticKind::not_text, span, "this is no source text; " + reason);
  }

  void report_invalid(const Token& token, const Text& text) {
    const std::string written = in_quotes(text.of(token));
    const Span span = text.span_of(token);
    if (token.kind == TokenKind::malformed_number) {
      diagnostics_.add(DiagnosticKind::malformed_number, span, written + " is not a number",
                       "numbers: 10, 1.5, 1e3, $FF hexadecimal, %1010 binary");
    } else if (token.kind == TokenKind::line_too_long) {
      diagnostics_.add(DiagnosticKind::line_too_long, {text.file, token.offset, 0},
                       "a line with " + std::to_string(token.length) + " bytes of code; at most " +
                           std::to_string(maximum_line_length) + " are read");
    } else if (token.kind == TokenKind::number_too_large) {
      diagnostics_.add(DiagnosticKind::number_too_large, span, written + " is too large");
    } else {
      diagnostics_.add(DiagnosticKind::unexpected_character, span, "unexpected character " + written);
    }
  }

  // ---- names

  void define(const Symbol& symbol) {
    const Symbol* const taken = symbols_.insert(symbol);
    if (taken == nullptr) return;
    const bool same_constant =
        symbol.kind == SymbolKind::constant && taken->kind == SymbolKind::constant && symbol.value == taken->value;
    if (same_constant) return;
    diagnostics_.add(DiagnosticKind::duplicate_name, symbol.span, in_quotes(symbol.name) + " is defined already",
                     "first defined here", taken->span);
  }

  void define_constant(const Statement& statement, const Text& text) {
    const Scope scope = scope_of(text, symbols_.symbols().size());
    const TokenRange value = statement.operands.front();
    const Evaluation evaluation = evaluate(value, scope, diagnostics_);
    if (evaluation.state == Evaluation::State::undefined) {
      undefined_in_constants_.push_back(text.span_of(*find_undefined_name(value, scope)));
    }
    // Defined even if its value is not known, so that its uses are no further errors.
    define({text.of(statement.name), SymbolKind::constant, evaluation.value, text.span_of(statement.name)});
  }

  // ---- instructions

  void add_instruction(const Statement& statement, const Text& text) {
    const InstructionSpec* const instruction = find_instruction(statement.name, text);
    const auto address = static_cast<std::uint32_t>(commands_.size());
    const std::uint32_t start = statement.name.offset;
    const Span span{text.file, start, statement.tokens[statement.tokens.size() - 2].end() - start};
    commands_.emplace_back();  // also for what is wrong, so that the addresses of labels stay right
    source_map_.push_back(span);
    if (instruction == nullptr) return;
    const auto visible_constants = static_cast<std::uint32_t>(symbols_.symbols().size());
    const Scope scope = scope_of(text, visible_constants);
    const Encoding encoding = encoder_.encode(*instruction, statement, scope, Pass::reading, commands_.back());
    if (encoding == Encoding::undefined_names) fixups_.push_back({address, span, visible_constants});
  }

  const InstructionSpec* find_instruction(const Token& name, const Text& text) {
    const InstructionSpec* const instruction = find_packed_mnemonic(name.packed);
    if (instruction == nullptr) {
      report_unknown_instruction(name, text);
      return nullptr;
    }
    if (contains(instruction->modules, options_->module->id)) return instruction;
    report_not_available(*instruction, text.span_of(name));
    return nullptr;
  }

  [[gnu::cold]] void report_unknown_instruction(const Token& name, const Text& text) {
    const std::string_view mnemonic = text.of(name);
    Suggestion suggestion(mnemonic);
    for (const InstructionSpec& row : instructions) {
      if (row.mnemonic != nullptr && diagnostics_.wants_suggestions()) suggestion.consider(row.mnemonic);
    }
    diagnostics_.add(DiagnosticKind::unknown_instruction, text.span_of(name),
                     "there is no instruction " + in_quotes(mnemonic), suggestion.text(), {},
                     fix_of(suggestion, text.span_of(name)));
  }

  [[gnu::cold]] void report_not_available(const InstructionSpec& instruction, Span span) {
    std::string note;
    for (const ModuleDescription& module : modules) {
      if (!contains(instruction.modules, module.id)) continue;
      note += (note.empty() ? "only on the " : " and the ") + describe(module);
    }
    if (const char* const substitute = substitute_for(instruction.opcode)) note += std::string("; ") + substitute;
    diagnostics_.add(DiagnosticKind::instruction_not_available, span,
                     std::string(instruction.mnemonic) + " is not available on the " + describe(*options_->module),
                     note);
  }

  // ---- directives

  void follow_directive(const Token& token, const Text& text) {
    const std::optional<std::string_view> file_name = included_file_name(text.of(token));
    if (!file_name) {
      diagnostics_.add(DiagnosticKind::unknown_directive, text.span_of(token),
                       "the only directive is #include, not " + in_quotes(text.of(token)));
      return;
    }
    if (file_name->empty()) {
      diagnostics_.add(DiagnosticKind::missing_file_name, text.span_of(token), "expected a file name after #include");
      return;
    }
    const auto offset = static_cast<std::uint32_t>(file_name->data() - text.characters.data());
    include_file(*file_name, {text.file, offset, static_cast<std::uint32_t>(file_name->size())});
  }

  void include_file(std::string_view name, Span place) {
    if (open_files_.size() >= maximum_include_depth || sources_.size() >= maximum_files) {
      diagnostics_.add(DiagnosticKind::too_many_includes, place,
                       "more than " + std::to_string(maximum_include_depth) + " files within each other, or " +
                           std::to_string(maximum_files) + " in all");
      return;
    }
    const std::string& including_file = sources_[place.file].name;
    IncludeSearchResult found =
        search_include(name, including_file, options_->include_path, *options_->module, *files_);
    switch (found.state) {
      case FileContent::State::found:
        return include_text(std::move(found), place);
      case FileContent::State::missing:
        diagnostics_.add(DiagnosticKind::file_not_found, place, "there is no file " + in_quotes(name), found.note);
        return;
      case FileContent::State::unreadable:
        diagnostics_.add(DiagnosticKind::file_not_readable, place, in_quotes(found.path) + " cannot be read");
        return;
      case FileContent::State::too_large:
        diagnostics_.add(DiagnosticKind::file_too_large, place, in_quotes(found.path) + too_large_text());
        return;
    }
  }

  void include_text(IncludeSearchResult found, Span place) {
    for (const FileId open : open_files_) {
      if (!is_same_path(sources_[open].name, found.path)) continue;
      diagnostics_.add(DiagnosticKind::include_cycle, place, in_quotes(found.path) + " includes itself");
      return;
    }
    if (total_size_ + found.text.size() > maximum_text_size) {
      diagnostics_.add(DiagnosticKind::file_too_large, place,
                       "with " + in_quotes(found.path) + " the source" + too_large_text());
      return;
    }
    read_text(sources_.add(std::move(found.path), std::move(found.text), found.is_built_in));
  }

  // ---- the end

  void finish() {
    finish_fixups();
    finish_constants();
    if (options_->append_stop) append_stop();
    check_capacity();
    if (options_->check_program && !diagnostics_.has_errors()) {
      check_program({commands_, source_map_, symbols_, sources_, *options_->module}, diagnostics_);
    }
    find_unknown_warnings(sources_, diagnostics_);
  }

  void finish_fixups() {
    Statement statement;
    for (const Fixup& fixup : fixups_) {
      const Text text = text_of(fixup.statement.file);
      Lexer lexer(text.characters, fixup.statement.offset);
      read_statement(lexer, statement);
      const InstructionSpec& instruction = *find_packed_mnemonic(statement.name.packed);
      const Scope scope = scope_of(text, fixup.visible_constants);
      encoder_.encode(instruction, statement, scope, Pass::finishing, commands_[fixup.address]);
    }
  }

  void finish_constants() {
    for (const Span& name : undefined_in_constants_) {
      const std::string_view written = sources_.text_of(name);
      const Symbol* const symbol = symbols_.find(written);
      if (symbol == nullptr) {
        report_undefined_name(name, written, symbols_, {}, diagnostics_);
      } else {
        diagnostics_.add(DiagnosticKind::used_before_definition, name,
                         in_quotes(written) + " is used before its definition", "defined here", symbol->span);
      }
    }
  }

  void append_stop() {
    if (!commands_.empty() && commands_.back().opcode == static_cast<std::uint8_t>(Opcode::stop)) return;
    commands_.push_back({static_cast<std::uint8_t>(Opcode::stop), 0, 0, 0});
    source_map_.push_back({0, static_cast<std::uint32_t>(sources_[0].text.size()), 0});
  }

  void check_capacity() {
    const std::size_t capacity = options_->module->program_capacity;
    if (!options_->check_capacity || commands_.size() <= capacity) return;
    diagnostics_.add(DiagnosticKind::program_too_large, source_map_[capacity],
                     "the program has " + std::to_string(commands_.size()) + " instructions; the " +
                         describe(*options_->module) + " holds " + std::to_string(capacity));
  }

  AssemblyResult result() {
    AssemblyResult assembly;
    assembly.diagnostics = without_switched_off(diagnostics_.take_sorted(), sources_);
    if (options_->warnings_as_errors) {
      for (Diagnostic& diagnostic : assembly.diagnostics) {
        diagnostic.is_warning_as_error = severity_of(diagnostic.kind) == Severity::warning;
      }
    }
    if (count(assembly.diagnostics).errors == 0) assembly.program = program();
    assembly.symbols = std::move(symbols_);
    assembly.sources = std::move(sources_);
    return assembly;
  }

  Program program() {
    Program program;
    program.labels.reserve(symbols_.symbols().size());
    for (const Symbol& symbol : symbols_.symbols()) {
      if (symbol.kind != SymbolKind::label) continue;
      program.labels.push_back({std::string(symbol.name), static_cast<std::uint32_t>(symbol.value), symbol.span});
    }
    program.commands = std::move(commands_);
    program.source_map = std::move(source_map_);
    return program;
  }

  Text text_of(FileId file) const { return {file, sources_[file].text}; }

  Scope scope_of(const Text& text, std::size_t visible_constants) {
    return {text.file, text.characters, &symbols_, visible_constants};
  }

  const AssemblerOptions* options_;
  FileProvider* files_;
  Sources sources_;
  DiagnosticList diagnostics_;
  InstructionEncoder encoder_;
  SymbolTable symbols_;
  std::vector<Command> commands_;
  std::vector<Span> source_map_;
  std::vector<Fixup> fixups_;
  std::vector<Span> undefined_in_constants_;  // names in values of constants, not known where they stand
  std::vector<FileId> open_files_;
  std::size_t total_size_ = 0;  // of all texts, in bytes
};

}  // namespace

AssemblyResult assemble(std::string_view file_name, std::string text, const AssemblerOptions& options,
                        FileProvider& files) {
  return Assembler(options, files).assemble(file_name, std::move(text));
}

InstructionResult parse_instruction(std::string_view text, const ModuleDescription& module) {
  MemoryFiles no_files;
  AssemblerOptions options;
  options.module = &module;
  Assembler assembler(options, no_files);
  assembler.define_built_in_constants();
  return assembler.assemble_instruction(text);
}

}  // namespace opentmcl::lang
