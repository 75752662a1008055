#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "lang/formatter.hpp"

namespace opentmcl::app {

/// What `edits` change in `source`, as `patch -p1` and `git apply` take it: from a/PATH to b/PATH, three lines of
/// context around each change. Empty if there are no edits.
std::string unified_diff(std::string_view path, std::string_view source, const std::vector<lang::LineEdit>& edits);

}  // namespace opentmcl::app
