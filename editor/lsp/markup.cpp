#include <string>

#include "editor/lsp/requests.hpp"

namespace opentmcl::editor::lsp {

json markup(const lang::Explanation& explanation, const ClientAbilities& client) {
  std::string text = client.markdown ? "```tmcl\n" + explanation.title + "\n```" : explanation.title;
  bool in_list = false;
  for (const std::string& line : explanation.lines) {
    const bool is_item = line.compare(0, 2, "- ") == 0;
    // In Markdown an empty line ends a paragraph; within a list none is needed.
    text += client.markdown && !(is_item && in_list) ? "\n\n" : "\n";
    text += line;
    in_list = is_item;
  }
  return {{"kind", client.markdown ? "markdown" : "plaintext"}, {"value", lang::to_utf8(text)}};
}

}  // namespace opentmcl::editor::lsp
