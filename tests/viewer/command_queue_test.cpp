/// A page's command waits until the run has had time of its own.

#include "prostm/viewer/detail/command_queue.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace prostm {
namespace {

using viewer::CommandQueue;
using Kind = LiveCommand::Kind;
using namespace std::chrono_literals;

class Queue : public testing::Test {
 protected:
  bool set(int control, double value) {
    return queue_.add(LiveCommand{Kind::Set, 1, control, value}, now_);
  }
  bool ask(Kind kind) { return queue_.add(LiveCommand{kind, 1}, now_); }
  /// The commands received by the run so far.
  std::vector<LiveCommand> asked() {
    std::vector<LiveCommand> all;
    LiveCommand command;
    while (control_.next(command)) all.push_back(command);
    return all;
  }
  void answer_after(std::chrono::milliseconds time) {
    now_ += time;
    queue_.answered(now_);
  }
  void pass(std::chrono::milliseconds time) {
    now_ += time;
    queue_.hand_over(now_);
  }

  LiveControl control_;
  CommandQueue queue_{control_};
  CommandQueue::Clock::time_point now_ = CommandQueue::Clock::now();
};

TEST_F(Queue, PassesTheFirstCommandAtOnceAndTheNextAfterTheRunHasAdvanced) {
  EXPECT_TRUE(set(3, 1.0));
  EXPECT_EQ(asked().size(), 1U);
  EXPECT_TRUE(set(3, 2.0));
  pass(400ms);
  EXPECT_TRUE(asked().empty()) << "the run has not answered yet";
  answer_after(1ms);
  pass(49ms);
  EXPECT_TRUE(asked().empty()) << "the run has advanced less than 50 ms";
  pass(1ms);
  EXPECT_EQ(asked().size(), 1U);
}

TEST_F(Queue, KeepsTheNewestValueOfEachControl) {
  set(0, 0.0);
  asked();
  for (int i = 1; i <= 2000; ++i) {
    EXPECT_TRUE(set(1, i));
    EXPECT_TRUE(set(2, -i));
  }
  answer_after(1ms);
  pass(50ms);
  const auto commands = asked();
  ASSERT_EQ(commands.size(), 2U);
  EXPECT_EQ(commands[0].value, 2000.0);
  EXPECT_EQ(commands[1].value, -2000.0);
}

TEST_F(Queue, DropsNoStepAndKeepsTheOrder) {
  set(0, 0.0);
  asked();
  ask(Kind::Play);
  ask(Kind::Step);
  ask(Kind::Step);
  ask(Kind::Pause);
  answer_after(1ms);
  pass(50ms);
  const auto commands = asked();
  ASSERT_EQ(commands.size(), 3U);
  EXPECT_EQ(commands[0].kind, Kind::Step);
  EXPECT_EQ(commands[1].kind, Kind::Step);
  EXPECT_EQ(commands[2].kind, Kind::Pause);
}

TEST_F(Queue, IsLimitedInLength) {
  int taken = 0;
  while (taken < 1000 && ask(Kind::Step)) ++taken;
  EXPECT_EQ(taken, 1 + 64);
  pass(999ms);
  EXPECT_EQ(asked().size(), 1U);
  pass(1ms);
  EXPECT_EQ(asked().size(), 64U) << "without an answer, commands pass after a second";
}

}  // namespace
}  // namespace prostm
