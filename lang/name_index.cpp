#include "lang/name_index.hpp"

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <tuple>
#include <unordered_map>

#include "lang/lexer.hpp"
#include "lang/source_line.hpp"

namespace opentmcl::lang {

NameIndex::NameIndex(const Sources& sources) {
  std::unordered_map<std::string_view, FileId> ids;
  for (FileId file = 0; file < sources.size(); ++file) {
    const auto [found, is_new] = ids.emplace(sources[file].name, file);
    first_ids_.push_back(found->second);
    if (is_new) read(file, sources[file].text);
  }
}

void NameIndex::read(FileId file, std::string_view text) {
  Lexer lexer(text);
  SourceLine line;
  while (!lexer.at_end()) {
    read_source_line(lexer, text, line);
    for (std::size_t i = 0; i < line.token_count(); ++i) {
      const TokenRole role = line.roles[i];
      if (role != TokenRole::label && role != TokenRole::constant && role != TokenRole::name) continue;
      const Token& token = line.token(i);
      const Span span{file, token.offset, token.length};
      uses_.push_back({span, number_of(token.text(text), span), role != TokenRole::name});
    }
  }
}

std::uint32_t NameIndex::number_of(std::string_view name, Span span) {
  const Symbol* const known = names_.find(name);
  if (known != nullptr) return static_cast<std::uint32_t>(known - names_.symbols().data());
  Symbol symbol;
  symbol.name = name;
  symbol.span = span;
  names_.insert(symbol);
  return static_cast<std::uint32_t>(names_.symbols().size() - 1);
}

const NameUse* NameIndex::at(FileId file, std::size_t offset) const {
  const FileId id = first_ids_[file];
  const auto behind = std::partition_point(uses_.begin(), uses_.end(), [&](const NameUse& use) {
    return std::tuple(use.span.file, std::size_t{use.span.offset}) <= std::tuple(id, offset);
  });
  if (behind == uses_.begin()) return nullptr;
  const NameUse& use = behind[-1];
  const bool is_there = use.span.file == id && offset <= std::size_t{use.span.offset} + use.span.length;
  return is_there ? &use : nullptr;
}

std::vector<NameUse> NameIndex::uses_of(std::uint32_t number) const {
  std::vector<NameUse> found;
  std::copy_if(uses_.begin(), uses_.end(), std::back_inserter(found),
               [&](const NameUse& use) { return use.number == number; });
  return found;
}

std::vector<NameUse> NameIndex::uses_of(std::string_view name) const {
  const Symbol* const known = names_.find(name);
  if (known == nullptr) return {};
  return uses_of(static_cast<std::uint32_t>(known - names_.symbols().data()));
}

}  // namespace opentmcl::lang
