#include "client/program_transfer.hpp"

#include <gtest/gtest.h>

#include "client/scripted_transport.hpp"
#include "firmware/spec/instructions.hpp"

namespace opentmcl::client {
namespace {

const std::vector<Command> program{{static_cast<std::uint8_t>(Opcode::ror), 0, 0, 350},
                                   {static_cast<std::uint8_t>(Opcode::stop), 0, 0, 0}};

Reply reply(std::uint8_t opcode, Status status = Status::ok) {
  return {2, 1, status, opcode, 0};
}
Reply reply(Opcode opcode, Status status = Status::ok) {
  return reply(static_cast<std::uint8_t>(opcode), status);
}

bool keep_going(std::size_t, std::size_t) {
  return true;
}

struct ProgramTransfer : testing::Test {
  ScriptedTransport transport;
  Client client{transport};

  std::vector<std::uint8_t> opcodes() const {
    std::vector<std::uint8_t> found;
    for (const Request& request : transport.requests()) found.push_back(request.command.opcode);
    return found;
  }
  void answer_instruction(const Command& command) { transport.answer(encode(Request{2, command})); }
  void answer_protection(std::int32_t value) { transport.answer(Reply{2, 1, Status::ok, ggp, value}); }

  static constexpr auto ggp = static_cast<std::uint8_t>(Opcode::ggp);
};

TEST_F(ProgramTransfer, StopsTheProgramAndSendsTheInstructionsInDownloadMode) {
  transport.answer(reply(Opcode::stop_application));
  transport.answer(reply(Opcode::enter_download_mode));
  for (const Command& command : program) transport.answer(reply(command.opcode, Status::command_loaded));
  transport.answer(reply(Opcode::exit_download_mode));

  std::vector<std::size_t> progress;
  const Result<void> done = download(client, program, 50, [&](std::size_t count, std::size_t total) {
    EXPECT_EQ(program.size(), total);
    progress.push_back(count);
    return true;
  });
  ASSERT_TRUE(done.ok());
  EXPECT_EQ((std::vector<std::uint8_t>{128, 132, 1, 28, 133}), opcodes());
  EXPECT_EQ(50, transport.requests().at(1).command.value);
  EXPECT_EQ((std::vector<std::size_t>{1, 2}), progress);
}

TEST(EndMark, StandsBehindAProgramThatLeavesRoomForIt) {
  std::vector<Command> marked = program;
  marked.push_back({0, 0, 0, 0});
  EXPECT_EQ(marked, with_end_mark(program, program.size() + 1));
  EXPECT_EQ(program, with_end_mark(program, program.size()));
}

TEST_F(ProgramTransfer, LeavesDownloadModeWhenAnInstructionIsRefused) {
  transport.answer(reply(Opcode::stop_application));
  transport.answer(reply(Opcode::enter_download_mode));
  transport.answer(reply(Opcode::ror, Status::program_memory_full));
  transport.answer(reply(Opcode::exit_download_mode));
  const Result<void> done = download(client, program, 0, keep_going);
  ASSERT_FALSE(done.ok());
  EXPECT_EQ(ErrorKind::refused, done.error().kind);
  EXPECT_EQ(Status::program_memory_full, done.error().status);
  EXPECT_EQ((std::vector<std::uint8_t>{128, 132, 1, 133}), opcodes());
}

TEST_F(ProgramTransfer, CanBeInterrupted) {
  transport.answer(reply(Opcode::stop_application));
  transport.answer(reply(Opcode::enter_download_mode));
  transport.answer(reply(Opcode::ror, Status::command_loaded));
  transport.answer(reply(Opcode::exit_download_mode));
  const Result<void> done = download(client, program, 0, [](std::size_t, std::size_t) { return false; });
  ASSERT_FALSE(done.ok());
  EXPECT_EQ(ErrorKind::interrupted, done.error().kind);
  EXPECT_EQ((std::vector<std::uint8_t>{128, 132, 1, 133}), opcodes());
}

TEST_F(ProgramTransfer, VerifiesWhatTheModuleHas) {
  for (const Command& command : program) answer_instruction(command);
  EXPECT_TRUE(verify(client, program, 0, keep_going).ok());
}

TEST_F(ProgramTransfer, NamesTheFirstInstructionThatDiffers) {
  answer_instruction(program[0]);
  answer_instruction(program[0]);
  const Result<void> done = verify(client, program, 10, keep_going);
  ASSERT_FALSE(done.ok());
  EXPECT_EQ(ErrorKind::protocol, done.error().kind);
  EXPECT_NE(std::string::npos, done.error().message.find("instruction 11"));
}

TEST_F(ProgramTransfer, RefusesAnInstructionWithAWrongChecksum) {
  Datagram broken = encode(Request{2, program[0]});
  broken.bytes[8] ^= 1;
  transport.answer(broken);
  const Result<Command> found = read_instruction(client, 0);
  ASSERT_FALSE(found.ok());
  EXPECT_EQ(ErrorKind::protocol, found.error().kind);
}

TEST_F(ProgramTransfer, ReadsAProgramToItsEnd) {
  for (const std::uint8_t end : {std::uint8_t{0}, std::uint8_t{255}}) {
    answer_protection(2);  // against writing
    for (const Command& command : program) answer_instruction(command);
    answer_instruction({end, end, end, 0});
    std::vector<std::size_t> progress;
    const Result<std::vector<Command>> found = read_program(client, 2048, [&](std::size_t count, std::size_t total) {
      EXPECT_EQ(2048U, total);
      progress.push_back(count);
      return true;
    });
    ASSERT_TRUE(found.ok());
    EXPECT_EQ(program, *found);
    EXPECT_EQ((std::vector<std::size_t>{1, 2}), progress);
  }
}

TEST_F(ProgramTransfer, ReadsNoFurtherThanTheMemory) {
  answer_protection(0);
  for (const Command& command : program) answer_instruction(command);
  const Result<std::vector<Command>> found = read_program(client, 2, keep_going);
  ASSERT_TRUE(found.ok());
  EXPECT_EQ(program, *found);
}

TEST_F(ProgramTransfer, DoesNotTakeAProtectedProgramForNone) {
  answer_protection(3);
  const Result<std::vector<Command>> found = read_program(client, 2048, keep_going);
  ASSERT_FALSE(found.ok());
  EXPECT_EQ(ErrorKind::refused, found.error().kind);
  EXPECT_NE(std::string::npos, found.error().message.find("protected against reading"));
  EXPECT_EQ(std::vector<std::uint8_t>{ggp}, opcodes());
}

TEST_F(ProgramTransfer, SaysWhenThereIsNoProgram) {
  answer_protection(0);
  answer_instruction({0, 0, 0, 0});
  const Result<std::vector<Command>> found = read_program(client, 2048, keep_going);
  ASSERT_FALSE(found.ok());
  EXPECT_NE(std::string::npos, found.error().message.find("no program"));
}

TEST_F(ProgramTransfer, CanBeInterruptedWhileReading) {
  answer_protection(0);
  answer_instruction(program[0]);
  const Result<std::vector<Command>> found = read_program(client, 2048, [](std::size_t, std::size_t) { return false; });
  ASSERT_FALSE(found.ok());
  EXPECT_EQ(ErrorKind::interrupted, found.error().kind);
}

}  // namespace
}  // namespace opentmcl::client
