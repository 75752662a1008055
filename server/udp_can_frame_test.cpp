#include "server/udp_can_frame.hpp"

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <algorithm>
#include <string>

namespace opentmcl::server {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// MessagePack of `{"arbitration_id": 1, "is_extended_id": …, "data": …, …}` by hand, as far as a test needs it.
class Packet {
 public:
  Packet& with(const std::string& field, Bytes value) {
    bytes_.push_back(static_cast<std::uint8_t>(0xA0 | field.size()));
    bytes_.insert(bytes_.end(), field.begin(), field.end());
    bytes_.insert(bytes_.end(), value.begin(), value.end());
    ++fields_;
    return *this;
  }
  Bytes bytes() const {
    Bytes all{static_cast<std::uint8_t>(0x80 | fields_)};
    all.insert(all.end(), bytes_.begin(), bytes_.end());
    return all;
  }

 private:
  Bytes bytes_;
  unsigned fields_ = 0;
};

const Bytes nil{0xC0};
const Bytes no{0xC2};
const Bytes yes{0xC3};

Packet of_python_can() {
  Packet packet;
  packet.with("timestamp", {0xCB, 0, 0, 0, 0, 0, 0, 0, 0}).with("channel", nil).with("dlc", {7});
  return packet;
}

TEST(UdpCanFrame, ReadsWhatPythonCanSends) {
  const auto frame = decode_udp_can_frame(of_python_can()
                                              .with("arbitration_id", {0xCD, 0x07, 0xFF})
                                              .with("is_extended_id", no)
                                              .with("is_remote_frame", no)
                                              .with("data", {0xC4, 3, 6, 1, 0xFF})
                                              .bytes());
  ASSERT_TRUE(frame.has_value());
  EXPECT_EQ(frame->id, 0x7FFU);
  EXPECT_FALSE(frame->is_extended);
  ASSERT_EQ(frame->length, 3);
  EXPECT_EQ(frame->data[0], 6);
  EXPECT_EQ(frame->data[1], 1);
  EXPECT_EQ(frame->data[2], 0xFF);
}

TEST(UdpCanFrame, RefusesAllButDataFramesOfClassicalCan) {
  const Bytes empty{0xC4, 0};
  const auto is_frame = [&](const Packet& packet) { return decode_udp_can_frame(packet.bytes()).has_value(); };
  EXPECT_TRUE(is_frame(Packet().with("arbitration_id", {1}).with("data", empty)));
  for (const char* flag : {"is_remote_frame", "is_error_frame", "is_fd"}) {
    EXPECT_FALSE(is_frame(Packet().with("arbitration_id", {1}).with("data", empty).with(flag, yes))) << flag;
  }
  EXPECT_FALSE(is_frame(Packet().with("data", empty))) << "no identifier";
  EXPECT_FALSE(is_frame(Packet().with("arbitration_id", {1}))) << "no data";
  EXPECT_FALSE(is_frame(Packet().with("arbitration_id", {0xFF}).with("data", empty))) << "-1";
  EXPECT_FALSE(is_frame(Packet().with("arbitration_id", {0xCD, 8, 0}).with("data", empty))) << "800h needs 29 bits";
  EXPECT_TRUE(is_frame(Packet().with("arbitration_id", {0xCD, 8, 0}).with("is_extended_id", yes).with("data", empty)));
  EXPECT_FALSE(is_frame(Packet().with("arbitration_id", {1}).with("data", {0xC4, 9, 1, 2, 3, 4, 5, 6, 7, 8, 9})));
  EXPECT_FALSE(is_frame(Packet().with("arbitration_id", {1}).with("data", {0xA1, 'x'}))) << "text";
}

TEST(UdpCanFrame, ReadsWhatItWrites) {
  EXPECT_TRUE(rc::check("any frame", [] {
    hal::CanFrame frame;
    frame.is_extended = *rc::gen::arbitrary<bool>();
    frame.id = *rc::gen::inRange<std::uint32_t>(0, frame.is_extended ? 0x2000'0000 : 0x800);
    frame.length = *rc::gen::inRange<std::uint8_t>(0, 9);
    for (std::size_t i = 0; i < frame.length; ++i) frame.data[i] = *rc::gen::arbitrary<std::uint8_t>();
    const auto read = decode_udp_can_frame(encode_udp_can_frame(frame, 1.7e9));
    RC_ASSERT(read.has_value());
    RC_ASSERT(read->id == frame.id && read->is_extended == frame.is_extended && read->length == frame.length);
    RC_ASSERT(std::equal(frame.data, frame.data + 8, read->data));
  }));
}

TEST(UdpCanFrame, SurvivesAnyBytes) {
  EXPECT_TRUE(rc::check("any bytes", [](const Bytes& bytes) {
    const auto frame = decode_udp_can_frame(bytes);
    RC_ASSERT(!frame || frame->length <= 8);
  }));
}

}  // namespace
}  // namespace opentmcl::server
