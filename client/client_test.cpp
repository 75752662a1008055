#include "client/client.hpp"

#include <gtest/gtest.h>

#include "client/scripted_transport.hpp"
#include "firmware/spec/instructions.hpp"

namespace opentmcl::client {
namespace {

constexpr std::uint8_t gap = static_cast<std::uint8_t>(Opcode::gap);
constexpr std::uint8_t mvp = static_cast<std::uint8_t>(Opcode::mvp);

Reply reply(std::uint8_t opcode, std::int32_t value, Status status = Status::ok) {
  return {2, 1, status, opcode, value};
}

struct ClientTest : testing::Test {
  ScriptedTransport transport;
  Client client{transport};
};

TEST_F(ClientTest, ReadsAnAxisParameter) {
  transport.answer(reply(gap, -711));
  const Result<std::int32_t> value = client.axis_parameter(AxisParameter::actual_position);
  ASSERT_TRUE(value.ok());
  EXPECT_EQ(-711, *value);
  EXPECT_EQ((Request{1, {gap, 1, 0, 0}}), transport.requests().at(0));
}

TEST_F(ClientTest, TurnsANegativeVelocityIntoRotateLeft) {
  transport.answer(reply(static_cast<std::uint8_t>(Opcode::rol), 0));
  ASSERT_TRUE(client.rotate(-350).ok());
  EXPECT_EQ((Command{static_cast<std::uint8_t>(Opcode::rol), 0, 0, 350}), transport.requests().at(0).command);
}

TEST_F(ClientTest, SaysWhatTheStatusOfARefusalMeans) {
  transport.answer(reply(mvp, 0, Status::invalid_value));
  const Result<void> moved = client.move_to(1000);
  ASSERT_FALSE(moved.ok());
  EXPECT_EQ(ErrorKind::refused, moved.error().kind);
  EXPECT_EQ(Status::invalid_value, moved.error().status);
  EXPECT_NE(std::string::npos, moved.error().message.find("MVP: status 4, invalid value"));
}

TEST_F(ClientTest, TakesACommandThatBecameAPartOfTheProgramForRefused) {
  transport.answer(reply(gap, 0, Status::command_loaded));
  const Result<std::int32_t> value = client.axis_parameter(AxisParameter::actual_position);
  ASSERT_FALSE(value.ok());
  EXPECT_EQ(ErrorKind::refused, value.error().kind);
  EXPECT_NE(std::string::npos, value.error().message.find("download mode"));
}

TEST_F(ClientTest, WaitsNoLongerThanItsTimeLimit) {
  const Result<void> moved = client.move_to(1000);
  ASSERT_FALSE(moved.ok());
  EXPECT_EQ(ErrorKind::timeout, moved.error().kind);
  EXPECT_EQ(Duration(std::chrono::seconds(1)), transport.now());
}

TEST_F(ClientTest, RepeatsAReadWhoseAnswerIsMissing) {
  transport.answer_nothing();
  transport.answer(reply(gap, 5));
  const Result<std::int32_t> value = client.axis_parameter(AxisParameter::actual_speed);
  ASSERT_TRUE(value.ok());
  EXPECT_EQ(5, *value);
  EXPECT_EQ(2u, transport.requests().size());
}

TEST_F(ClientTest, SendsAMoveOnlyOnce) {
  transport.answer_nothing();
  transport.answer(reply(mvp, 0));
  EXPECT_FALSE(client.move_by(1000).ok());
  EXPECT_EQ(1u, transport.requests().size());
}

TEST_F(ClientTest, ReadsOnlyOnceWhatReadingClears) {
  transport.answer_nothing();
  transport.answer(reply(gap, 0));
  EXPECT_FALSE(client.axis_parameter(AxisParameter::extended_error_flags).ok());
  EXPECT_EQ(1u, transport.requests().size());
}

TEST_F(ClientTest, RefusesAnAnswerWithAWrongChecksumAndGetsBackIntoStep) {
  Datagram broken = encode(reply(mvp, 0));
  broken.bytes[5] ^= 0x40;
  ScriptedTransport::Bytes bytes(broken.bytes, broken.bytes + datagram_size);
  bytes.insert(bytes.end(), {1, 2, 3});  // and garbage behind it
  transport.answer(bytes);
  transport.answer(reply(gap, 42));

  const Result<void> moved = client.move_to(0);
  ASSERT_FALSE(moved.ok());
  EXPECT_EQ(ErrorKind::protocol, moved.error().kind);
  const Result<std::int32_t> value = client.axis_parameter(AxisParameter::actual_position);
  ASSERT_TRUE(value.ok());
  EXPECT_EQ(42, *value);
  EXPECT_EQ(2u, transport.requests().size());
}

TEST_F(ClientTest, RefusesTheAnswerToAnotherCommand) {
  transport.answer(reply(gap, 7));
  const Result<void> moved = client.move_to(0);
  ASSERT_FALSE(moved.ok());
  EXPECT_EQ(ErrorKind::protocol, moved.error().kind);
}

TEST_F(ClientTest, TakesALateAnswerForNobodysAnswer) {
  transport.answer(encode(reply(gap, 1)));
  ASSERT_TRUE(client.axis_parameter(AxisParameter::actual_position).ok());
  ScriptedTransport::Bytes half(4, 0xAA);
  transport.answer(half);
  transport.answer(reply(gap, 2));
  const Result<std::int32_t> value = client.axis_parameter(AxisParameter::actual_position);
  ASSERT_TRUE(value.ok());
  EXPECT_EQ(2, *value);
}

TEST_F(ClientTest, PassesOverTheSecondReplyOfCommand138) {
  const Datagram second =
      encode(reply(static_cast<std::uint8_t>(Opcode::request_position_reached), 1, Status::position_reached));
  const Datagram wanted = encode(reply(gap, 3));
  ScriptedTransport::Bytes bytes(second.bytes, second.bytes + datagram_size);
  bytes.insert(bytes.end(), wanted.bytes, wanted.bytes + datagram_size);
  transport.answer(bytes);
  const Result<std::int32_t> value = client.axis_parameter(AxisParameter::actual_position);
  ASSERT_TRUE(value.ok());
  EXPECT_EQ(3, *value);
}

TEST_F(ClientTest, SaysThatThePortIsGone) {
  transport.unplug();
  const Result<std::int32_t> value = client.axis_parameter(AxisParameter::actual_position);
  ASSERT_FALSE(value.ok());
  EXPECT_EQ(ErrorKind::input_output, value.error().kind);
}

TEST_F(ClientTest, ReadsTheVersionInBothForms) {
  transport.answer(reply(static_cast<std::uint8_t>(Opcode::get_firmware_version), 0x0489012F));
  transport.answer(ScriptedTransport::Bytes{2, '1', '1', '6', '1', 'V', '1', '4', '7'});
  const Result<FirmwareVersion> version = client.firmware_version();
  ASSERT_TRUE(version.ok());
  EXPECT_EQ(1161, version->type_number);
  EXPECT_EQ(1, version->major);
  EXPECT_EQ(47, version->minor);
  EXPECT_EQ(&pd1161, version->module());
  const Result<std::string> text = client.firmware_version_text();
  ASSERT_TRUE(text.ok());
  EXPECT_EQ("1161V147", *text);
}

TEST_F(ClientTest, KnowsNoModuleOfAForeignType) {
  EXPECT_EQ(nullptr, (FirmwareVersion{1640, 1, 0}.module()));
}

TEST_F(ClientTest, TakesTheProgramStatusApart) {
  transport.answer(reply(static_cast<std::uint8_t>(Opcode::get_application_status), 0x01010203));
  const Result<ProgramStatus> status = client.program_status();
  ASSERT_TRUE(status.ok());
  EXPECT_EQ(ProgramStatus::State::running, status->state);
  EXPECT_TRUE(status->waiting);
  EXPECT_EQ(0x0203, status->program_counter);
}

TEST(ExitCodes, AreThoseOfTheManualPage) {
  EXPECT_EQ(1, exit_code_of(ErrorKind::refused));
  EXPECT_EQ(64, exit_code_of(ErrorKind::usage));
  EXPECT_EQ(65, exit_code_of(ErrorKind::bad_file));
  EXPECT_EQ(69, exit_code_of(ErrorKind::no_such_device));
  EXPECT_EQ(70, exit_code_of(ErrorKind::internal));
  EXPECT_EQ(74, exit_code_of(ErrorKind::input_output));
  EXPECT_EQ(75, exit_code_of(ErrorKind::timeout));
  EXPECT_EQ(76, exit_code_of(ErrorKind::protocol));
  EXPECT_EQ(130, exit_code_of(ErrorKind::interrupted));
}

}  // namespace
}  // namespace opentmcl::client
