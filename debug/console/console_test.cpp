#include "debug/console/console.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "debug/console/place.hpp"
#include "debug/debugging_test.hpp"

namespace opentmcl::debug {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

/// A module without registers of its own: the program counter moves on with each step.
class CountingTarget final : public Target {
 public:
  client::Client& client() override { return client_; }
  const ModuleDescription& module() const override { return pd1161; }
  client::Result<client::ProgramStatus> status() override { return status_; }
  client::Result<client::ProgramStatus> restart() override {
    status_ = {client::ProgramStatus::State::running, false, 0};
    return status_;
  }
  client::Result<client::ProgramStatus> step(std::uint16_t, const Command& instruction) override {
    if (static_cast<Opcode>(instruction.opcode) == Opcode::stop) {
      status_.state = client::ProgramStatus::State::stopped;
    } else {
      ++status_.program_counter;
    }
    return status_;
  }
  void rest() override {}
  client::Result<void> let_run() override { return {}; }
  client::Result<client::ProgramStatus> halt() override { return status_; }
  client::Result<client::ProgramStatus> jump(std::uint16_t) override {
    return client::Error{client::ErrorKind::usage, "no", {}};
  }
  unsigned steps_a_slice() const override { return 1; }

 private:
  class Silence final : public client::Transport {
   public:
    client::Result<void> send(std::span<const std::uint8_t>) override { return {}; }
    client::Result<std::size_t> receive(std::span<std::uint8_t>, client::Duration limit) override {
      now_ += limit;
      return std::size_t{0};
    }
    void drain() override {}
    void pause(client::Duration duration) override { now_ += duration; }
    client::Duration now() const override { return now_; }
    const std::string& name() const override { return name_; }

   private:
    client::Duration now_{0};
    std::string name_ = "silence";
  };

  Silence transport_;
  client::Client client_{transport_};
  client::ProgramStatus status_;
};

struct Terminal {
  explicit Terminal(Console::Options options = {})
      : engine(target, program_of("First: CALC ADD, 1\nCALC ADD, 2\nSecond: CALC ADD, 3\nCALC ADD, 4\nSTOP\n")),
        console(engine,
                {[this](const std::string& text) { shown.push_back(text); },
                 [] { return false; },
                 [this](std::chrono::milliseconds time) { slept += time; },
                 {}},
                options) {
    value_of(engine.restart());
  }

  Console::Outcome type(std::string_view line) {
    shown.clear();
    return value_of(console.execute(line));
  }
  std::string mistake(std::string_view line) {
    const auto outcome = console.execute(line);
    return outcome ? "" : outcome.error().message;
  }

  CountingTarget target;
  Engine engine;
  std::vector<std::string> shown;
  std::chrono::milliseconds slept{0};
  Console console;
};

TEST(Console, ShowsTheLineAfterAStep) {
  Terminal terminal;
  terminal.type("step");
  EXPECT_THAT(terminal.shown, ElementsAre("First+1, program.tmc:2", " =>    2 CALC ADD, 2"));
  EXPECT_EQ("(tmcl First+1) ", terminal.console.prompt());
}

TEST(Console, TakesShortNamesAndUnambiguousBegins) {
  Terminal terminal;
  terminal.type("s");
  terminal.type("ste");
  EXPECT_EQ(2, terminal.engine.stop().address);
  EXPECT_THAT(terminal.mistake("re"), HasSubstr("restart"));
  EXPECT_THAT(terminal.mistake("stpe"), HasSubstr("did you mean step?"));
}

TEST(Console, AnEmptyLineRepeatsAStepButNoBreakpoint) {
  Terminal terminal;
  terminal.type("step");
  terminal.type("");
  EXPECT_EQ(2, terminal.engine.stop().address);
  terminal.type("break 4");
  terminal.type("");
  EXPECT_EQ(1U, terminal.engine.breakpoints().size());
}

TEST(Console, EveryCommandHasHelpAndABreakpointItsDescription) {
  Terminal terminal;
  for (const ConsoleCommand* command : console_commands()) {
    terminal.type("help " + std::string(command->name));
    EXPECT_THAT(terminal.shown.front(), HasSubstr(std::string(command->summary)));
  }
  terminal.type("break Second+1 if X > 3 hits % 2");
  EXPECT_THAT(terminal.shown, ElementsAre("breakpoint 1: Second+1, program.tmc:4, if X > 3, hits % 2"));
}

TEST(Console, RunStopsAtABreakpointAtTheBegin) {
  Terminal terminal;
  terminal.type("tbreak First");
  terminal.type("run");
  EXPECT_THAT(terminal.shown.front(), HasSubstr("breakpoint 1, at First"));
  EXPECT_EQ(0, terminal.engine.stop().address);
  terminal.type("break Second");
  terminal.type("run");
  EXPECT_EQ(2, terminal.engine.stop().address) << "the first one is gone";
  terminal.type("delete");
  EXPECT_THAT(terminal.engine.breakpoints(), IsEmpty());
  terminal.type("break First if PC > 0");
  terminal.type("run");
  EXPECT_TRUE(terminal.engine.has_ended());
}

TEST(Console, ACountOfStepsEndsWhereTheProgramDoes) {
  Terminal terminal;
  terminal.type("step 3");
  EXPECT_EQ(3, terminal.engine.stop().address);
  terminal.type("step 10");
  EXPECT_THAT(terminal.shown.front(), HasSubstr("the program has ended"));
}

TEST(Console, ShowsDisplaysWheneverTheProgramStands) {
  Terminal terminal;
  terminal.type("display PC * 2");
  EXPECT_THAT(terminal.shown, ElementsAre("1: PC * 2 = 0"));
  terminal.type("step");
  EXPECT_EQ("1: PC * 2 = 2", terminal.shown.back());
  terminal.type("undisplay 1");
  terminal.type("step");
  EXPECT_THAT(terminal.shown, Not(Contains(HasSubstr("PC * 2"))));
  EXPECT_THAT(terminal.mistake("display Nowhere"), HasSubstr("neither a register"));
}

TEST(Console, WordsMayBePartedByTabs) {
  Terminal terminal;
  terminal.type("break\tSecond+1\t");
  EXPECT_EQ(3, terminal.engine.breakpoints().at(1).request.address);
  terminal.type("disable\t1");
  EXPECT_FALSE(terminal.engine.breakpoints().at(1).enabled);
  EXPECT_THAT(terminal.mistake("break Second+18446744073709551615"), HasSubstr("not in the program"));
}

TEST(Console, UntilAndTemporaryBreakpointsLeaveNothingBehind) {
  Terminal terminal;
  terminal.type("tbreak Second");
  terminal.type("continue");
  EXPECT_EQ(2, terminal.engine.stop().address);
  EXPECT_THAT(terminal.engine.breakpoints(), IsEmpty());
  terminal.type("until *3");
  EXPECT_EQ(3, terminal.engine.stop().address);
}

TEST(Console, AnimatesAtTheSpeedThatIsWanted) {
  Terminal terminal;
  terminal.type("animate 4");
  EXPECT_TRUE(terminal.engine.has_ended());
  EXPECT_EQ(std::chrono::milliseconds(4 * 250), terminal.slept);
  EXPECT_THAT(terminal.mistake("animate 0"), HasSubstr("steps a second"));
}

TEST(Console, ListsTheSourceAroundTheProgram) {
  Terminal terminal;
  terminal.type("break Second");
  terminal.type("list");
  EXPECT_THAT(terminal.shown, Contains(" =>    1 First: CALC ADD, 1"));
  EXPECT_THAT(terminal.shown, Contains("*      3 Second: CALC ADD, 3"));
}

TEST(Console, CompletesCommandsLabelsAndRegisters) {
  Terminal terminal;
  EXPECT_THAT(terminal.console.completions("reverse-"),
              ElementsAre("reverse-step", "reverse-next", "reverse-finish", "reverse-continue"));
  EXPECT_THAT(terminal.console.completions("break se"), ElementsAre("Second"));
  EXPECT_THAT(terminal.console.completions("print GAP(1) + ga"), ElementsAre("GAP"));
  EXPECT_THAT(terminal.console.completions("info br"), ElementsAre("breakpoints"));
  EXPECT_THAT(terminal.console.completions("nonsense x"), IsEmpty());
}

TEST(Console, LeavesWhenTold) {
  Terminal terminal;
  EXPECT_EQ(Console::Outcome::quit, terminal.type("q"));
  EXPECT_EQ(Console::Outcome::detach, terminal.type("detach"));
  EXPECT_EQ(Console::Outcome::done, terminal.type("# a comment"));
}

TEST(Console, SaysWhatIsWrong) {
  Terminal terminal;
  const std::pair<const char*, const char*> expected[] = {{"break Nowhere", "no label 'Nowhere'"},
                                                          {"break Secnd", "did you mean Second?"},
                                                          {"break 99", "no instruction on line 99"},
                                                          {"break other.inc:1", "no file 'other.inc'"},
                                                          {"break *5000", "an address below 2048"},
                                                          {"break First if", "expected an expression behind 'if'"},
                                                          {"break First if A >", "expected a number"},
                                                          {"break First hits x", "count of hits"},
                                                          {"delete 7", "no breakpoint 7"},
                                                          {"delete x", "number of a breakpoint"},
                                                          {"step x", "expected a count"},
                                                          {"catch fire", "expected stall"},
                                                          {"signal velocity > 1", "twin"},
                                                          {"measure velocity", "twin"},
                                                          {"reverse-step", "does not go back"},
                                                          {"set A", "WHAT = EXPRESSION"},
                                                          {"set VAR(300) = 1", "no user variable 300"},
                                                          {"set colour = 1", "expected A, X"},
                                                          {"set A = 1.5", "whole number"},
                                                          {"info", "expected registers"},
                                                          {"undisplay 3", "no display"},
                                                          {"log First", "expected a message"},
                                                          {"until", "expected a place"},
                                                          {"print", "expected an expression"},
                                                          {"print MVP ABS, 0, 1", "has no value"}};
  for (const auto& [line, message] : expected) EXPECT_THAT(terminal.mistake(line), HasSubstr(message)) << line;
}

TEST(Console, SourcesPutNoControlCharactersOnTheTerminal) {
  CountingTarget target;
  Engine engine(target, program_of("CALC ADD, 1 // \033[31m red\n"));
  std::vector<std::string> shown;
  Console console(engine, {[&](const std::string& text) { shown.push_back(text); }, [] { return false; }, {}, {}}, {});
  console.show_stop(value_of(engine.restart()));
  EXPECT_THAT(shown.back(), Not(HasSubstr("\033")));
}

}  // namespace
}  // namespace opentmcl::debug
