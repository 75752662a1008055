#include "firmware/wire/framer.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>
#include <rapidcheck/gtest.h>

#include <algorithm>
#include <vector>

namespace opentmcl {
namespace {

using Bytes = std::vector<std::uint8_t>;

Bytes content(const Framer& framer) {
  const Datagram& datagram = framer.datagram();
  return {datagram.bytes, datagram.bytes + datagram_size};
}

RC_GTEST_PROP(Framer, FindsTheSameDatagramsInPiecesOfAnySize, (const Bytes& stream, std::uint8_t piece)) {
  std::vector<Bytes> expected;
  Framer byte_by_byte;
  for (const std::uint8_t byte : stream) {
    if (byte_by_byte.push(byte, 0)) expected.push_back(content(byte_by_byte));
  }

  std::vector<Bytes> found;
  Framer in_pieces;
  const std::size_t largest = std::size_t{piece} % datagram_size + 1;
  for (auto next = stream.begin(); next != stream.end();) {
    std::uint8_t* const room = in_pieces.room(0);
    const std::size_t left = static_cast<std::size_t>(stream.end() - next);
    const std::size_t count = std::min({largest, in_pieces.missing(), left});
    std::copy_n(next, count, room);
    next += static_cast<std::ptrdiff_t>(count);
    if (!in_pieces.filled(count, 0)) continue;
    found.push_back(content(in_pieces));
    in_pieces.reset();
  }
  RC_ASSERT(found == expected);
  RC_ASSERT(found.size() == stream.size() / datagram_size);
}

TEST(Framer, DropsAnUnfinishedDatagramAfterTheGap) {
  constexpr Microseconds five_milliseconds = 5000;  // written out, so that a changed gap is noticed
  for (const Microseconds silence : {five_milliseconds, five_milliseconds + 1}) {
    Framer framer;
    framer.push(1, 0);
    for (std::size_t i = 1; i < datagram_size; ++i) framer.push(2, silence);
    EXPECT_EQ(framer.is_complete(), silence <= five_milliseconds);
  }
}

TEST(Framer, SilenceWithoutBytesDoesNotProlongTheGap) {
  Framer framer;
  framer.push(1, 0);
  framer.room(Framer::gap);
  framer.filled(0, Framer::gap);
  framer.room(Framer::gap + 1);
  EXPECT_EQ(framer.missing(), datagram_size);
}

TEST(Framer, KeepsACompleteDatagramHoweverLongItWaits) {
  Framer framer;
  for (std::uint8_t i = 0; i < datagram_size; ++i) framer.push(i, 0);
  framer.room(100 * Framer::gap);
  ASSERT_TRUE(framer.is_complete());
  EXPECT_EQ(content(framer), (Bytes{0, 1, 2, 3, 4, 5, 6, 7, 8}));
}

}  // namespace
}  // namespace opentmcl
