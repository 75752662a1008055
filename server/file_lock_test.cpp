#include "server/file_lock.hpp"

#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>

namespace opentmcl::server {
namespace {

namespace fs = std::filesystem;

struct FileLockTest : testing::Test {
  FileLockTest() : path((fs::temp_directory_path() / ("file_lock_test." + std::to_string(::getpid()))).string()) {}
  ~FileLockTest() override { fs::remove(path + ".lock"); }

  std::string path;
};

TEST_F(FileLockTest, KeepsASecondUserAwayUntilItIsReleased) {
  {
    const client::Result<FileLock> first = FileLock::acquire(path);
    ASSERT_TRUE(first.ok());
    const client::Result<FileLock> second = FileLock::acquire(path);
    ASSERT_FALSE(second.ok());
    EXPECT_EQ(client::ErrorKind::bad_file, second.error().kind);
  }
  EXPECT_TRUE(FileLock::acquire(path).ok());
}

TEST_F(FileLockTest, LeavesNothingBehind) {
  { ASSERT_TRUE(FileLock::acquire(path).ok()); }
  EXPECT_FALSE(fs::exists(path + ".lock"));
}

TEST_F(FileLockTest, IsNotStoppedByALockFileNobodyHolds) {
  std::ofstream(path + ".lock") << "left behind";
  EXPECT_TRUE(FileLock::acquire(path).ok());
}

TEST_F(FileLockTest, NeedsAFolderItCanWrite) {
  const client::Result<FileLock> lock = FileLock::acquire("/no/such/folder/file");
  ASSERT_FALSE(lock.ok());
  EXPECT_EQ(client::ErrorKind::input_output, lock.error().kind);
}

}  // namespace
}  // namespace opentmcl::server
