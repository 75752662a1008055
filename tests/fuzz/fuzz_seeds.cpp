// fuzz_seeds FOLDER PROGRAM…: makes the corpora the fuzzers start from, FOLDER/assembler and so on, of TMCL programs.
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <fstream>
#include <string>
#include <string_view>
#include <vector>

#include "lang/assembler.hpp"
#include "lang/lexer.hpp"
#include "lang/statement.hpp"

namespace {

namespace fs = std::filesystem;
using namespace opentmcl;

class Corpora {
 public:
  explicit Corpora(fs::path folder) : folder_(std::move(folder)) { fs::remove_all(folder_); }

  void add(const char* corpus, const std::string& name, std::string_view content) {
    fs::create_directories(folder_ / corpus);
    std::ofstream file(folder_ / corpus / name, std::ios::binary);
    file.exceptions(std::ios::failbit | std::ios::badbit);
    file.write(content.data(), static_cast<std::streamsize>(content.size()));
    file.close();
  }

 private:
  fs::path folder_;
};

/// Seven bytes an instruction, as fuzz_disassembler takes them.
std::string bytes_of(const std::vector<Command>& commands) {
  std::string bytes;
  for (const Command& command : commands) {
    std::uint8_t packed[7] = {command.opcode, command.type, command.motor};
    put_int32(packed + 3, command.value);
    bytes.append(packed, packed + sizeof packed);
  }
  return bytes;
}

/// The operands of all instructions and the values of all constants.
std::vector<std::string> expressions_of(std::string_view source) {
  std::vector<std::string> expressions;
  lang::Lexer lexer(source);
  lang::Statement statement;
  while (!lexer.at_end()) {
    lang::read_statement(lexer, statement);
    for (const lang::TokenRange operand : statement.operands) {
      if (operand.empty()) continue;
      const std::uint32_t start = operand.first->offset;
      expressions.emplace_back(source.substr(start, operand.last[-1].end() - start));
    }
  }
  return expressions;
}

void add_program(Corpora& corpora, const std::string& path, const std::string& name) {
  lang::DiskFiles files;
  const lang::FileContent content = files.read(path);
  corpora.add("assembler", name, content.text);
  corpora.add("formatter", name, content.text);
  const std::vector<std::string> expressions = expressions_of(content.text);
  for (std::size_t i = 0; i < expressions.size(); ++i) {
    corpora.add("expression", name + "_" + std::to_string(i), expressions[i]);
  }
  for (const ModuleDescription& module : modules) {
    lang::AssemblerOptions options;
    options.module = &module;
    const lang::AssemblyResult result = lang::assemble(path, content.text, options, files);
    if (result.program) corpora.add("disassembler", name + module.argument, bytes_of(result.program->commands));
  }
}

}  // namespace

int main(int argument_count, char** arguments) {
  try {
    if (argument_count < 3) {
      std::fprintf(stderr, "usage: fuzz_seeds FOLDER PROGRAM...\n");
      return 64;
    }
    Corpora corpora(arguments[1]);
    for (int i = 2; i < argument_count; ++i) add_program(corpora, arguments[i], std::to_string(i));
    return 0;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "fuzz_seeds: %s\n", error.what());
    return 74;
  }
}
