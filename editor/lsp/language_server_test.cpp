// What has to hold for any text: nothing makes the server fail, and it is the text that counts, not the way to it. What
// it says to a client is in conversations/.
#include "editor/lsp/language_server.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "lang/formatter.hpp"

namespace opentmcl::editor::lsp {
namespace {

const std::string main_uri = "file:///lab/main.tmc";

/// A server that has been initialized.
class Client {
 public:
  explicit Client(const std::string& encoding = "utf-16")
      : server_([this](const json& message) { said_.push_back(message); }, files_) {
    request("initialize", {{"capabilities", {{"general", {{"positionEncodings", json::array({encoding})}}}}}});
    notify("initialized", json::object());
  }

  void notify(const std::string& method, json parameters) {
    server_.take({{"jsonrpc", "2.0"}, {"method", method}, {"params", std::move(parameters)}});
  }

  /// The result or the error.
  json request(const std::string& method, json parameters) {
    server_.take({{"jsonrpc", "2.0"}, {"id", ++id_}, {"method", method}, {"params", std::move(parameters)}});
    json answer = said_.back();
    EXPECT_EQ(answer["id"], id_);
    return answer.contains("result") ? answer["result"] : answer["error"];
  }

  void open(const std::string& text, const std::string& uri = main_uri) {
    notify("textDocument/didOpen",
           {{"textDocument", {{"uri", uri}, {"languageId", "tmcl"}, {"version", 0}, {"text", text}}}});
  }

  void change(json changes) {
    notify("textDocument/didChange",
           {{"textDocument", {{"uri", main_uri}, {"version", ++version_}}}, {"contentChanges", std::move(changes)}});
  }

  /// The diagnostics that are published now.
  json published() {
    said_.clear();
    server_.publish();
    return said_.empty() ? json() : said_.back()["params"]["diagnostics"];
  }

  json about_document(const std::string& method) {
    return request(method, {{"textDocument", {{"uri", main_uri}}}, {"options", json::object()}});
  }

 private:
  lang::MemoryFiles files_;
  std::vector<json> said_;
  LanguageServer server_;
  int id_ = 0;
  int version_ = 0;
};

rc::Gen<std::string> any_source() {
  static const std::vector<std::string> pieces = {"SAP",
                                                  "MVP ",
                                                  "ABS",
                                                  "GE",
                                                  ",",
                                                  ", ",
                                                  " ",
                                                  ":",
                                                  "=",
                                                  "(",
                                                  ")",
                                                  "+",
                                                  "-",
                                                  "*",
                                                  "^",
                                                  "/",
                                                  "4",
                                                  "0",
                                                  "500",
                                                  "1.",
                                                  "$F",
                                                  "%",
                                                  "#include ",
                                                  "TMCLParam.tmc",
                                                  "\"",
                                                  "//",
                                                  ";",
                                                  "\n",
                                                  "\n",
                                                  "\r\n",
                                                  "\r",
                                                  "\t",
                                                  "Loop",
                                                  "Loop:",
                                                  "Speed",
                                                  "Speed = 1\n",
                                                  "SIN(",
                                                  "JA Loop\n",
                                                  "STOP\n",
                                                  "// module: tmcm1110\n",
                                                  "// no-warning: all\n",
                                                  "\xC3\xBC",
                                                  "\xF0\x9F\x98\x80",
                                                  "!",
                                                  "#",
                                                  "\xEF\xBB\xBF",
                                                  "main.tmc\n"};
  return rc::gen::map(rc::gen::container<std::vector<std::string>>(rc::gen::elementOf(pieces)),
                      [](const std::vector<std::string>& chosen) {
                        std::string text;
                        for (const std::string& piece : chosen) text += piece;
                        return text;
                      });
}

/// Anywhere in the text, and a little beside it.
json any_position() {
  return {{"line", *rc::gen::inRange(0, 20)}, {"character", *rc::gen::inRange(0, 40)}};
}

RC_GTEST_PROP(LanguageServer, AnswersEveryRequestAboutAnyText, ()) {
  Client client;
  client.open(*any_source());
  client.open(*any_source(), "file:///lab/other.inc");
  RC_ASSERT(client.published().is_array());
  const json document = {{"uri", main_uri}};
  const json place = {{"textDocument", document},
                      {"position", any_position()},
                      {"newName", "New_Name"},
                      {"context", {{"includeDeclaration", true}, {"diagnostics", json::array()}}},
                      {"range", {{"start", any_position()}, {"end", any_position()}}},
                      {"query", "o"},
                      {"options", json::object()}};
  for (const char* method :
       {"textDocument/hover", "textDocument/signatureHelp", "textDocument/inlayHint", "textDocument/completion",
        "textDocument/definition", "textDocument/references", "textDocument/documentHighlight",
        "textDocument/documentSymbol", "workspace/symbol", "textDocument/prepareRename", "textDocument/rename",
        "textDocument/semanticTokens/full", "textDocument/semanticTokens/range", "textDocument/foldingRange",
        "textDocument/formatting", "textDocument/rangeFormatting", "textDocument/codeAction"}) {
    const json result = client.request(method, place);
    // Renaming may be refused; everything else has an answer.
    const bool is_refused = result.is_object() && result.contains("code");
    if (is_refused) RC_ASSERT(result["code"] == number_of(ErrorCode::request_failed));
  }
}

RC_GTEST_PROP(LanguageServer, KnowsTheSameTextFromEditsAndAsAWhole, ()) {
  const std::string encoding = *rc::gen::element<std::string>("utf-8", "utf-16");
  const PositionEncoding counted = encoding == "utf-8" ? PositionEncoding::utf8 : PositionEncoding::utf16;
  Client edited(encoding);
  std::string text = *any_source();
  edited.open(text);
  const int edits = *rc::gen::inRange(1, 6);
  for (int i = 0; i < edits; ++i) {
    const json start = any_position();
    const json end = any_position();
    const std::string inserted = *any_source();
    edited.change(json::array({{{"range", {{"start", start}, {"end", end}}}, {"text", inserted}}}));
    // What an editor does to its own text.
    const TextIndex index(text, counted);
    const std::size_t from = index.offset_of(*position_of(start));
    const std::size_t to = std::max(from, index.offset_of(*position_of(end)));
    text.replace(from, to - from, inserted);
    if (*rc::gen::arbitrary<bool>()) edited.published();
  }
  Client whole(encoding);
  whole.open("STOP\n");
  whole.change(json::array({{{"text", text}}}));
  for (const char* method : {"textDocument/semanticTokens/full", "textDocument/documentSymbol",
                             "textDocument/foldingRange", "textDocument/formatting"}) {
    RC_ASSERT(edited.about_document(method) == whole.about_document(method));
  }
}

/// Applies what the server wants to be changed, as a client does.
std::string applied(json edits, const std::string& text) {
  const TextIndex index(text, PositionEncoding::utf16);
  std::string result = text;
  std::reverse(edits.begin(), edits.end());  // the places of the others stay
  for (const json& edit : edits) {
    const std::optional<Range> range = range_of(edit["range"]);
    const std::size_t begin = index.offset_of(range->start);
    result.replace(begin, index.offset_of(range->end) - begin, edit["newText"].get<std::string>());
  }
  return result;
}

RC_GTEST_PROP(LanguageServer, FormatsAsTheFormatterDoes, ()) {
  const std::string text = *any_source();
  Client client;
  client.open(text);
  RC_ASSERT(applied(client.about_document("textDocument/formatting"), text) == lang::format_source(text));
}

TEST(LanguageServer, TakesATextThatIsTooLargeForTheAssembler) {
  Client client;
  client.open(std::string(lang::maximum_text_size + 1, ' '));
  EXPECT_EQ(client.published()[0]["code"], "file-too-large");
  EXPECT_EQ(client.request("textDocument/hover",
                           {{"textDocument", {{"uri", main_uri}}}, {"position", {{"line", 0}, {"character", 1000}}}}),
            nullptr);
}

TEST(LanguageServer, PublishesAtMostAThousandDiagnosticsOfAFile) {
  std::string text;
  for (int i = 0; i < 5000; ++i) text += "NOSUCH\n";
  Client client;
  client.open(text);
  EXPECT_EQ(client.published().size(), 1000U);
}

}  // namespace
}  // namespace opentmcl::editor::lsp
