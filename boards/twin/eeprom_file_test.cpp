#include "boards/twin/eeprom_file.hpp"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <filesystem>
#include <fstream>
#include <iterator>

namespace opentmcl {
namespace {

namespace fs = std::filesystem;
using Kind = EepromFileError::Kind;

std::string read_file(const fs::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

void write_file(const fs::path& path, const std::string& content) {
  std::ofstream(path, std::ios::binary) << content;
}

EepromFile::Image numbered_image() {
  EepromFile::Image image{};
  for (std::size_t i = 0; i < image.size(); ++i) image[i] = static_cast<std::uint8_t>(i * 7);
  return image;
}

struct EepromFileTest : testing::Test {
  EepromFileTest() {
    const testing::TestInfo& test = *testing::UnitTest::GetInstance()->current_test_info();
    folder = fs::temp_directory_path() / (std::string("eeprom_file_test.") + test.name());
    fs::remove_all(folder);
    fs::create_directories(folder);
    path = folder / "module.eeprom";
  }
  ~EepromFileTest() override { fs::remove_all(folder); }

  /// A file with this content is refused and stays as it is.
  void expect_refused(const std::string& content, const std::string& reason) {
    write_file(path, content);
    twin::Eeprom eeprom;
    EepromFile file(path.string(), pd1161);
    const auto error = file.load(eeprom);
    ASSERT_TRUE(error.has_value()) << reason;
    EXPECT_EQ(Kind::bad_content, error->kind);
    EXPECT_NE(std::string::npos, error->message.find(reason)) << error->message;
    EXPECT_EQ(std::string::npos, error->message.find('\n'));
    EXPECT_EQ(content, read_file(path));
    EXPECT_EQ(twin::Eeprom().image(), eeprom.image());
  }

  fs::path folder;
  fs::path path;
};

TEST_F(EepromFileTest, IsMadeWhenItDoesNotExist) {
  twin::Eeprom eeprom;
  EepromFile file(path.string(), pd1161);
  EXPECT_FALSE(file.load(eeprom).has_value());
  EXPECT_EQ(EepromFile::encode(eeprom.image(), pd1161), read_file(path));
}

TEST_F(EepromFileTest, KeepsWhatWasWritten) {
  const std::uint8_t data[] = {1, 2, 3};
  {
    twin::Eeprom eeprom;
    EepromFile file(path.string(), pd1161);
    ASSERT_FALSE(file.load(eeprom).has_value());
    eeprom.write_page(100, data, sizeof data, 0);
    ASSERT_FALSE(file.save(eeprom).has_value());
  }
  twin::Eeprom eeprom;
  EepromFile file(path.string(), pd1161);
  ASSERT_FALSE(file.load(eeprom).has_value());
  EXPECT_EQ(2, eeprom.image()[101]);
}

TEST_F(EepromFileTest, IsNotTouchedWhenNothingWasWritten) {
  twin::Eeprom eeprom;
  EepromFile file(path.string(), pd1161);
  ASSERT_FALSE(file.load(eeprom).has_value());
  fs::remove(path);
  EXPECT_FALSE(file.save(eeprom).has_value());
  EXPECT_FALSE(fs::exists(path));
}

TEST_F(EepromFileTest, KeepsItsPermissionsAndLeavesNothingBesideIt) {
  twin::Eeprom eeprom;
  EepromFile file(path.string(), pd1161);
  ASSERT_FALSE(file.load(eeprom).has_value());
  fs::permissions(path, fs::perms::owner_read | fs::perms::owner_write);
  const std::uint8_t data[] = {1};
  eeprom.write_page(0, data, 1, 0);
  ASSERT_FALSE(file.save(eeprom).has_value());
  EXPECT_EQ(fs::perms::owner_read | fs::perms::owner_write, fs::status(path).permissions());
  EXPECT_EQ(1, std::distance(fs::directory_iterator(folder), fs::directory_iterator()));
}

TEST_F(EepromFileTest, IsReplacedWhereALinkLeads) {
  const fs::path real = folder / "real.eeprom";
  write_file(real, EepromFile::encode(numbered_image(), pd1161));
  fs::create_symlink(real, path);
  twin::Eeprom eeprom;
  EepromFile file(path.string(), pd1161);
  ASSERT_FALSE(file.load(eeprom).has_value());
  const std::uint8_t data[] = {99};
  eeprom.write_page(0, data, 1, 0);
  ASSERT_FALSE(file.save(eeprom).has_value());
  EXPECT_TRUE(fs::is_symlink(path));
  EXPECT_EQ(EepromFile::encode(eeprom.image(), pd1161), read_file(real));
}

TEST_F(EepromFileTest, IsRefusedWhenItIsSomethingElse) {
  expect_refused("", "not an OpenTMCL EEPROM file");
  expect_refused("shopping list: milk\n", "not an OpenTMCL EEPROM file");
  expect_refused(std::string(100'000, 'x'), "not an OpenTMCL EEPROM file");
}

TEST_F(EepromFileTest, IsRefusedWhenItIsAnotherModules) {
  expect_refused(EepromFile::encode(numbered_image(), tmcm1110), "type 1110, not to a PD-1161");
}

TEST_F(EepromFileTest, IsRefusedWhenItIsOfALaterFormat) {
  std::string content = EepromFile::encode(numbered_image(), pd1161);
  content.replace(content.find("format: 1"), 9, "format: 2");
  expect_refused(content, "format 2, expected 1");
}

TEST_F(EepromFileTest, IsRefusedWhenItIsLonger) {
  expect_refused(EepromFile::encode(numbered_image(), pd1161) + "x", "1 bytes too many");
}

TEST_F(EepromFileTest, IsNoFolder) {
  fs::create_directory(path);
  twin::Eeprom eeprom;
  const auto error = EepromFile(path.string(), pd1161).load(eeprom);
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(Kind::input_output, error->kind);
}

TEST_F(EepromFileTest, NeedsAFolderItCanWrite) {
  twin::Eeprom eeprom;
  const auto error = EepromFile((folder / "none" / "file").string(), pd1161).load(eeprom);
  ASSERT_TRUE(error.has_value());
  EXPECT_EQ(Kind::input_output, error->kind);
}

RC_GTEST_PROP(EepromFileContent, IsRefusedWithAnyByteChanged, ()) {
  const std::string good = EepromFile::encode(numbered_image(), pd1161);
  std::string changed = good;
  const auto place = *rc::gen::inRange<std::size_t>(0, good.size());
  changed[place] = static_cast<char>(changed[place] ^ *rc::gen::inRange(1, 256));
  EepromFile::Image image{};
  RC_ASSERT(EepromFile::decode(changed, pd1161, image).has_value());
}

RC_GTEST_PROP(EepromFileContent, IsRefusedWhenTruncatedAnywhere, ()) {
  const std::string good = EepromFile::encode(numbered_image(), pd1161);
  EepromFile::Image image{};
  RC_ASSERT(
      EepromFile::decode(good.substr(0, *rc::gen::inRange<std::size_t>(0, good.size())), pd1161, image).has_value());
}

TEST(EepromFileContent, ComesBackAsItWas) {
  EepromFile::Image image{};
  ASSERT_FALSE(EepromFile::decode(EepromFile::encode(numbered_image(), tmcm1110), tmcm1110, image).has_value());
  EXPECT_EQ(numbered_image(), image);
}

}  // namespace
}  // namespace opentmcl
