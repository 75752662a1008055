#include "server/pty_link.hpp"

#include <gtest/gtest.h>

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>

namespace opentmcl::server {
namespace {

namespace fs = std::filesystem;

struct PtyLinkTest : testing::Test {
  PtyLinkTest() : folder(fs::temp_directory_path() / ("pty_link_test." + std::to_string(::getpid()))) {
    fs::create_directories(folder);
    link = (folder / "link").string();
    terminal = (folder / "terminal").string();
    std::ofstream(terminal) << "stands for a pseudo terminal";
  }
  ~PtyLinkTest() override { fs::remove_all(folder); }

  fs::path folder;
  std::string link;
  std::string terminal;
};

TEST_F(PtyLinkTest, ExistsAsLongAsItsObject) {
  {
    const client::Result<PtyLink> made = PtyLink::create(link, terminal);
    ASSERT_TRUE(made.ok()) << made.error().message;
    EXPECT_EQ(terminal, fs::read_symlink(link));
  }
  EXPECT_FALSE(fs::is_symlink(link));
}

TEST_F(PtyLinkTest, ReplacesALinkThatLeadsNowhere) {
  fs::create_symlink("/dev/pts/no_such_terminal", link);
  const client::Result<PtyLink> made = PtyLink::create(link, terminal);
  ASSERT_TRUE(made.ok()) << made.error().message;
  EXPECT_EQ(terminal, fs::read_symlink(link));
}

TEST_F(PtyLinkTest, TakesOverALinkToTheSameTerminal) {
  fs::create_symlink(terminal, link);
  EXPECT_TRUE(PtyLink::create(link, terminal).ok());
}

TEST_F(PtyLinkTest, LeavesTheLinkOfALiveTerminalAlone) {
  fs::create_symlink(terminal, link);
  const client::Result<PtyLink> made = PtyLink::create(link, "/dev/pts/another");
  ASSERT_FALSE(made.ok());
  EXPECT_EQ(client::ErrorKind::input_output, made.error().kind);
  EXPECT_EQ(terminal, fs::read_symlink(link));
}

TEST_F(PtyLinkTest, ReplacesTheLinkOfAKilledProgramWhoseTerminalIsSomebodyElsesNow) {
  fs::create_symlink(terminal, link);
  std::ofstream(link + ".lock") << "";
  const client::Result<PtyLink> made = PtyLink::create(link, "/dev/pts/another");
  ASSERT_TRUE(made.ok()) << made.error().message;
  EXPECT_EQ("/dev/pts/another", fs::read_symlink(link));
}

TEST_F(PtyLinkTest, LeavesALinkAloneThatAnotherObjectHas) {
  const client::Result<PtyLink> made = PtyLink::create(link, terminal);
  const client::Result<PtyLink> second = PtyLink::create(link, "/dev/pts/another");
  ASSERT_FALSE(second.ok());
  EXPECT_EQ(client::ErrorKind::input_output, second.error().kind);
  EXPECT_NE(second.error().message.find("in use"), std::string::npos) << second.error().message;
  EXPECT_EQ(terminal, fs::read_symlink(link));
}

TEST_F(PtyLinkTest, LeavesNothingBehind) {
  { const client::Result<PtyLink> made = PtyLink::create(link, terminal); }
  fs::remove(terminal);
  EXPECT_TRUE(fs::is_empty(folder));
}

TEST_F(PtyLinkTest, NeverReplacesAFile) {
  std::ofstream(link) << "precious";
  EXPECT_FALSE(PtyLink::create(link, terminal).ok());
  EXPECT_TRUE(fs::is_regular_file(link));
}

TEST_F(PtyLinkTest, DoesNotRemoveALinkThatSomebodyElseHasMadeHisOwn) {
  {
    const client::Result<PtyLink> made = PtyLink::create(link, terminal);
    ASSERT_TRUE(made.ok());
    fs::remove(link);
    fs::create_symlink("/dev/pts/another", link);
  }
  EXPECT_TRUE(fs::is_symlink(link));
}

TEST_F(PtyLinkTest, NeedsAFolderItCanWrite) {
  EXPECT_FALSE(PtyLink::create((folder / "no_such_folder" / "link").string(), terminal).ok());
}

}  // namespace
}  // namespace opentmcl::server
