// The requests of the protocol that look at a document. Each gives the result that the protocol has for it; where
// nothing is to be found, null or an empty list.
#pragma once

#include <cstddef>
#include <string>
#include <vector>

#include "editor/lsp/protocol.hpp"
#include "editor/lsp/view.hpp"
#include "lang/explanation.hpp"

namespace opentmcl::editor::lsp {

/// What the client said it can do with an answer.
struct ClientAbilities {
  bool markdown = false;             ///< in hovers and documentation
  bool related_information = false;  ///< in diagnostics
  bool nested_symbols = false;       ///< DocumentSymbol rather than SymbolInformation
  bool watches_files = false;        ///< can be asked to tell of files that change
};

// hover.cpp
json hover(const View& view, std::size_t offset, const ClientAbilities& client);
json signature_help(const View& view, std::size_t offset);
json inlay_hints(const View& view, std::size_t begin, std::size_t end);

// completion.cpp
json completion(const View& view, std::size_t offset, const ClientAbilities& client);

// navigation.cpp
json definition(const View& view, std::size_t offset);
json references(const View& view, std::size_t offset, bool with_definitions);
json document_highlights(const View& view, std::size_t offset);
json document_symbols(const View& view, const ClientAbilities& client);
/// Names that contain `query`, of all programs.
json workspace_symbols(Workspace& workspace, const std::string& query);

// renaming.cpp
Answer prepare_rename(const View& view, std::size_t offset);
/// @param views the document in each program it is a part of
Answer rename(const std::vector<View>& views, std::size_t offset, const std::string& new_name);

// colouring.cpp
json semantic_tokens(const View& view, std::size_t begin, std::size_t end);
/// Names of the kinds of tokens and of their modifiers, as the answers number them.
json semantic_tokens_legend();
json folding_ranges(const View& view);

// formatting.cpp
json formatting(const Document& document);
json range_formatting(const Document& document, std::size_t begin, std::size_t end);

// diagnostics.cpp
/// What is wrong with a file of a program, as it is published.
json diagnostics(const View& view, const ClientAbilities& client);
json code_actions(const View& view, std::size_t begin, std::size_t end, const ClientAbilities& client);

// markup.cpp
/// An explanation as the client can show it.
json markup(const lang::Explanation& explanation, const ClientAbilities& client);

}  // namespace opentmcl::editor::lsp
