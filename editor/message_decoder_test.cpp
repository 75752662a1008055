#include "editor/message_decoder.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <string>
#include <vector>

namespace opentmcl::editor {
namespace {

std::vector<std::string> bodies_in(MessageDecoder& decoder) {
  std::vector<std::string> bodies;
  while (std::optional<std::string> body = decoder.next()) bodies.push_back(std::move(*body));
  return bodies;
}

std::string error_of(std::string_view bytes) {
  MessageDecoder decoder;
  decoder.append(bytes);
  EXPECT_EQ(decoder.next(), std::nullopt);
  return decoder.error();
}

RC_GTEST_PROP(MessageDecoder, FindsMessagesHoweverTheStreamIsCut, (const std::vector<std::string>& sent)) {
  std::string stream;
  for (const std::string& body : sent) stream += with_header(body);
  MessageDecoder decoder;
  std::vector<std::string> received;
  for (std::size_t at = 0; at < stream.size();) {
    const auto size = *rc::gen::inRange<std::size_t>(1, 40);
    decoder.append(std::string_view(stream).substr(at, size));
    for (std::string& body : bodies_in(decoder)) received.push_back(std::move(body));
    at += size;
  }
  RC_ASSERT(received == sent);
  RC_ASSERT(!decoder.is_within_message());
}

RC_GTEST_PROP(MessageDecoder, SurvivesAnyBytes, (const std::string& before, const std::string& bytes)) {
  MessageDecoder decoder;
  decoder.append(before + "\r\nContent-Length: 3\r\n\r\n" + bytes);
  bodies_in(decoder);
  decoder.append("\r\n\r\n");
  bodies_in(decoder);
  RC_SUCCEED();
}

TEST(MessageDecoder, SkipsOtherFieldsAndTheCaseOfNames) {
  MessageDecoder decoder;
  decoder.append("content-type: application/vscode-jsonrpc; charset=utf-8\r\nCONTENT-LENGTH:  2 \r\n\r\n{}");
  EXPECT_EQ(decoder.next(), "{}");
}

TEST(MessageDecoder, WaitsForTheRestOfAMessage) {
  MessageDecoder decoder;
  decoder.append("Content-Length: 5\r\n\r\n[1");
  EXPECT_EQ(decoder.next(), std::nullopt);
  EXPECT_TRUE(decoder.is_within_message());
  decoder.append(",2");
  EXPECT_EQ(decoder.next(), std::nullopt) << "one byte too few";
  decoder.append("]");
  EXPECT_EQ(decoder.next(), "[1,2]");
}

TEST(MessageDecoder, SaysWhatIsWrongWithAHeader) {
  EXPECT_EQ(error_of("Content-Type: x\r\n\r\n{}"), "the header of a message has no field Content-Length");
  EXPECT_EQ(error_of("\r\n\r\n{}"), "the header of a message has no field Content-Length");
  EXPECT_EQ(error_of("GET / HTTP\r\n\r\n"), "expected a header field such as 'Content-Length: 100', not 'GET / HTTP'");
  EXPECT_EQ(error_of("Content-Length: -1\r\n\r\n"), "Content-Length must be a number of bytes, not '-1'");
  EXPECT_EQ(error_of("Content-Length: 2x\r\n\r\n"), "Content-Length must be a number of bytes, not '2x'");
  EXPECT_EQ(error_of("Content-Length: 67108865\r\n\r\n"),
            "Content-Length is '67108865'; messages have at most 67108864 bytes");
  EXPECT_EQ(error_of("Content-Length: 99999999999999999999999\r\n\r\n"),
            "Content-Length is '99999999999999999999999'; messages have at most 67108864 bytes");
  EXPECT_EQ(error_of("Content-Length: 2\r\nContent-Length: 3\r\n\r\n{}"),
            "the header of a message has two different fields Content-Length");
}

TEST(MessageDecoder, RefusesAHeaderWithoutEnd) {
  const std::string endless(MessageDecoder::longest_header + 1, 'x');
  EXPECT_EQ(error_of(endless), "the header of a message is longer than 8192 bytes");
}

TEST(MessageDecoder, ReadsNothingMoreAfterAnError) {
  MessageDecoder decoder;
  decoder.append("Content-Length: x\r\n\r\n");
  EXPECT_EQ(decoder.next(), std::nullopt);
  decoder.append(with_header("{}"));
  EXPECT_EQ(decoder.next(), std::nullopt);
  EXPECT_NE(decoder.error(), "");
}

}  // namespace
}  // namespace opentmcl::editor
