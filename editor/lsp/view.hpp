#pragma once

#include <cstddef>

#include "editor/lsp/protocol.hpp"
#include "editor/lsp/workspace.hpp"
#include "lang/source_line.hpp"

namespace opentmcl::editor::lsp {

/// A document as a part of a program: what most requests look at.
struct View {
  Workspace& workspace;
  const Document& document;
  Analysis& program;
  lang::FileId file = 0;  ///< the document among the files of the program

  std::string_view text() const { return program.sources()[file].text; }
  const TextIndex& index() const { return program.text_index(file); }

  /// `span` may be of any file that is not built in.
  json range(lang::Span span) const { return range_json(program.text_index(span.file), span.offset, span.length); }
  json location(lang::Span span) const {
    return {{"uri", workspace.uri_of(program.sources()[span.file])}, {"range", range(span)}};
  }

  /// The line that a place is in.
  lang::SourceLine line_at(std::size_t offset) const {
    lang::SourceLine line;
    lang::Lexer lexer(text(), lang::start_of_line(text(), offset));
    lang::read_source_line(lexer, text(), line);
    return line;
  }
};

}  // namespace opentmcl::editor::lsp
