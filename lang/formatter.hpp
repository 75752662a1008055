// Sources in the style of docs/formatting.md. The formatter changes no token but the case of mnemonics, words and
// functions, so the program stays the same; a line that is none of the language stays as it is, so that a source can be
// formatted while it is being written.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>
#include <vector>

namespace opentmcl::lang {

/// A line of the source that the formatter writes differently.
struct LineEdit {
  std::size_t line = 0;  ///< counts from 1
  std::string text;      ///< what stands in its place: one line or more, each with its end; empty if the line goes
};

struct Formatting {
  std::string text;
  std::vector<LineEdit> edits;               ///< that make `text` of the source, in the order of their lines
  std::vector<std::size_t> untouched_lines;  ///< those that are none of the language
};

/// `source` is at most `maximum_text_size` long. UTF-8 comes out, also of Latin-1. Lines end with LF, or with CR LF
/// where they all did before; so does the last one.
Formatting formatting_of(std::string_view source);

/// The text alone.
std::string format_source(std::string_view source);

}  // namespace opentmcl::lang
