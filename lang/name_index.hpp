#pragma once

#include <cstdint>
#include <string_view>
#include <vector>

#include "lang/source.hpp"
#include "lang/symbol_table.hpp"

namespace opentmcl::lang {

/// A place where a label or a constant is defined or used.
struct NameUse {
  Span span;
  std::uint32_t number = 0;  ///< the same for all uses of one name
  bool is_definition = false;
};

/// All places of all names in the sources of one program, whether anything defines them or not. Labels and constants
/// share one set of names, without case, over all files. A file that is included several times is looked at once.
class NameIndex {
 public:
  /// `sources` must outlive the index.
  explicit NameIndex(const Sources& sources);

  /// The use of a name that a place is in or directly behind, or nullptr. `file` may be any of the ids a file has.
  const NameUse* at(FileId file, std::size_t offset) const;

  /// In the order of the files and of the places in them.
  const std::vector<NameUse>& uses() const { return uses_; }
  std::vector<NameUse> uses_of(std::uint32_t number) const;
  std::vector<NameUse> uses_of(std::string_view name) const;

  /// How the name is written where it comes first.
  std::string_view name(std::uint32_t number) const { return names_.symbols()[number].name; }
  /// Whether the sources have a label or constant of this name, or use one.
  bool contains(std::string_view name) const { return names_.find(name) != nullptr; }

  /// The first of the ids the sources have for this file.
  FileId first_id_of(FileId file) const { return first_ids_[file]; }

 private:
  void read(FileId file, std::string_view text);
  std::uint32_t number_of(std::string_view name, Span span);

  std::vector<FileId> first_ids_;
  std::vector<NameUse> uses_;
  SymbolTable names_;  // here, of a symbol nothing but its name counts
};

}  // namespace opentmcl::lang
