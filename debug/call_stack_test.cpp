#include "debug/call_stack.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "debug/debugging_test.hpp"

namespace opentmcl::debug {
namespace {

using testing::ElementsAre;
using testing::IsEmpty;

/// A stack, and a program whose steps it is told.
struct Watched {
  explicit Watched(std::string_view source) : program(program_of(source)), stack(program.commands()) { stack.reset(); }

  void step(std::uint16_t before, std::uint16_t after) { stack.note(before, program.commands()[before], after); }

  Program program;
  CallStack stack;
};

constexpr std::string_view source = R"(
        VECT 0, Tick     // 0
        CSUB Sub         // 1
        JA Begin         // 2
Begin:  CALC ADD, 1      // 3
        RSUB             // 4
Sub:    CALC ADD, 2      // 5
        RSUB             // 6
Tick:   CSUB Sub         // 7
        RETI             // 8
)";

TEST(CallStack, FollowsSubroutines) {
  Watched watched(source);
  watched.step(1, 5);
  EXPECT_THAT(watched.stack.routines(), ElementsAre(OpenRoutine{2, false}));
  watched.step(5, 6);
  watched.step(6, 2);
  EXPECT_THAT(watched.stack.routines(), IsEmpty());
  EXPECT_TRUE(watched.stack.is_whole());
}

TEST(CallStack, SeesAnInterruptRoutineInAStepThatTheInstructionDoesNotExplain) {
  Watched watched(source);
  watched.step(3, 5);  // Tick: CSUB Sub was executed in place of CALC
  EXPECT_THAT(watched.stack.routines(), ElementsAre(OpenRoutine{3, true}, OpenRoutine{8, false}));
  watched.step(5, 6);
  watched.step(6, 8);
  watched.step(8, 3);
  EXPECT_THAT(watched.stack.routines(), IsEmpty());
  EXPECT_EQ(0, watched.stack.level());
}

TEST(CallStack, ACallThatIsIgnoredOpensNothing) {
  Watched watched(source);
  for (int i = 0; i < 8; ++i) watched.step(1, 5);
  EXPECT_EQ(8U, watched.stack.routines().size());
  watched.step(1, 2);
  EXPECT_EQ(8U, watched.stack.routines().size());
}

TEST(CallStack, AReturnThatIsIgnoredLeavesNothing) {
  Watched watched(source);
  watched.step(4, 5);
  EXPECT_EQ(0, watched.stack.level());
  EXPECT_TRUE(watched.stack.is_whole());
}

TEST(CallStack, CountsReturnsFromRoutinesNobodySawOpened) {
  Watched watched(source);
  watched.stack.forget();
  watched.step(6, 2);
  EXPECT_EQ(-1, watched.stack.level());
  EXPECT_FALSE(watched.stack.is_whole());
  watched.step(1, 5);
  EXPECT_EQ(0, watched.stack.level());
}

}  // namespace
}  // namespace opentmcl::debug
