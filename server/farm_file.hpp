#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/farm_description.hpp"

namespace opentmcl::server {

struct FarmFile {
  FarmDescription description;  ///< of use when there are no problems
  /// "farm.toml:3:1: error: ...", in the order of the file; all there are, unless it is no TOML at all.
  std::vector<std::string> problems;
};

/// Reads the TOML text of a farm file; docs/farm.md says what it may contain.
/// @param path of the file: for messages, and relative paths in it start from its folder
FarmFile read_farm(std::string_view text, const std::string& path);

/// The tables of docs/farm.md: each key of each section with what it takes.
std::string farm_file_reference();

}  // namespace opentmcl::server
