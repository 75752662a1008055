// A table that accepts everything would prove nothing: what does not happen must be noticed.
#include "tests/conformance/runner.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <stdexcept>

namespace opentmcl::conformance {
namespace {

using testing::HasSubstr;

/// What is wrong with a statement of these steps about a PD-1161; empty when nothing is.
std::string failure_of(const std::string& steps, const std::string& program = "") {
  const Statement statement{"id", "3", "says", Modules::both, hal::PortKind::usb, "", program, steps};
  return run(statement, ModuleId::pd1161).value_or("");
}

TEST(Runner, AcceptsWhatTheModuleDoes) {
  EXPECT_EQ(failure_of("SAP 4, 0, 500 -> 100\nGAP 4, 0 -> 100, 500\n"), "");
}

TEST(Runner, NoticesAWrongStatus) {
  EXPECT_THAT(failure_of("MST 0 -> 4"), HasSubstr("expected status 4, found 100"));
}

TEST(Runner, NoticesAWrongValue) {
  EXPECT_THAT(failure_of("GAP 4, 0 -> 100, 1..999"), HasSubstr("expected value 1 to 999, found 1000"));
}

TEST(Runner, NoticesAReplyWhereNoneShouldBe) {
  EXPECT_THAT(failure_of("MST 0 -> nothing"), HasSubstr("expected no reply"));
  EXPECT_THAT(failure_of("bytes 01 06 01 00 00 00 00 00 08 -> nothing"), HasSubstr("expected nothing, found 02 01 64"));
}

TEST(Runner, NoticesAMissingReply) {
  EXPECT_THAT(failure_of("137 0 0 1234 -> 100"), HasSubstr("there is no reply"));
  EXPECT_THAT(failure_of("bytes 01 06 -> 02"), HasSubstr("expected 02, found nothing"));
}

TEST(Runner, NoticesOneByteTooMany) {
  EXPECT_THAT(failure_of("bytes 01 06 01 00 00 00 00 00 08 -> 02 01 64 06 00 00 00 00"), HasSubstr("found 02 01"));
}

TEST(Runner, NoticesBytesThatDoNotCome) {
  EXPECT_THAT(failure_of("receive 02 within 10 ms"), HasSubstr("expected 02, found nothing"));
}

TEST(Runner, NoticesAValueThatIsNotReachedInTime) {
  EXPECT_THAT(failure_of("MVP ABS, 0, 100000 -> 100\nuntil GAP 8, 0 = 1 within 10 ms"), HasSubstr("still 0"));
}

TEST(Runner, NoticesTheBench) {
  EXPECT_THAT(failure_of("check output 0 = 1"), HasSubstr("expected 1, found 0"));
  EXPECT_EQ(failure_of("SIO 0, 2, 1 -> 100\ncheck output 0 = 1"), "");
}

TEST(Runner, StartsWithANewModuleEachTime) {
  EXPECT_EQ(failure_of("SAP 4, 0, 500 -> 100\nSTAP 4, 0 -> 100"), "");
  EXPECT_EQ(failure_of("GAP 4, 0 -> 100, 1000"), "");
}

TEST(Runner, DownloadsTheProgramButDoesNotRunIt) {
  const std::string program = "SGP 0, 2, 7\nSTOP\n";
  EXPECT_EQ(failure_of("wait 1 s\nGGP 0, 2 -> 100, 0", program), "");
  EXPECT_EQ(failure_of("run\nuntil GGP 0, 2 = 7 within 10 ms", program), "");
}

TEST(Runner, RefusesNamesTheBenchDoesNotHave) {
  EXPECT_THROW(failure_of("set lamp = 1"), std::runtime_error);
  EXPECT_THROW(failure_of("check output 9 = 1"), std::runtime_error);
}

}  // namespace
}  // namespace opentmcl::conformance
