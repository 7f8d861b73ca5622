/// What is said of a pose's age against a device of the test's own, which knows when each pose was made.

#include "device/link/lock_step.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <deque>
#include <functional>
#include <random>

namespace palpate::device {
namespace {

constexpr double millis = 1e-3;
constexpr double never = 1e9;

/// A device that answers each command once and in turn, after a time or never.
class AnsweringDevice {
 public:
  void command(double now, double way) {
    ++commands;
    if (way < never) answers_.push_back({now, now + way});
  }
  /// Delivers what has come, in turn. Returns how many; `made`: when the newest pose was made, if any came.
  std::uint64_t deliver(double now, double& made) {
    std::uint64_t count = 0;
    for (; !answers_.empty() && answers_.front().ready <= now; answers_.pop_front(), ++count) {
      made = answers_.front().made;
    }
    return count;
  }
  int commands = 0;

 private:
  struct Answer {
    double made, ready;
  };
  std::deque<Answer> answers_;
};

struct Played {
  double oldest_believed = 0;  ///< s: how old a pose was at most that was said to be current, when it came
  double longest_gap = 0;      ///< s without one
  int commands = 0;
  int believed = 0;
};

/// `way`: s from a command to its answer, at a time.
Played play(double seconds, const std::function<double(double)>& way, double steps = 0.2 * millis) {
  LockStep exchange;
  AnsweringDevice device;
  Played played;
  double made = 0, believed = 0;
  for (double now = 0; now < seconds; now += steps) {
    if (const std::uint64_t count = device.deliver(now, made); count > 0) {
      exchange.answered(count, now);
      if (exchange.is_current()) {
        played.oldest_believed = std::max(played.oldest_believed, now - made);
        played.longest_gap = std::max(played.longest_gap, now - believed);
        believed = now;
        ++played.believed;
      }
    }
    if (exchange.is_due(now)) {
      device.command(now, way(now));
      exchange.sent(now);
    }
  }
  played.longest_gap = std::max(played.longest_gap, seconds - believed);
  played.commands = device.commands;
  return played;
}

/// As long as no answer takes longer than 50 millis, whatever the delays and however they change, no pose that is said
/// to be current is older than 20 millis.
TEST(LockStep, NoLatePoseIsTakenForANewOne) {
  int late = 0, believed = 0;
  for (unsigned seed = 0; seed < 400; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> chance(0, 1);
    double delay = millis, until = 0;
    const Played played = play(3, [&](double now) {
      if (now > until) {
        delay = chance(random) < 0.4 ? millis : 49 * millis * chance(random);
        until = now + (chance(random) < 0.5 ? 0.3 : 0.01) * chance(random);
        late += delay > 20 * millis ? 1 : 0;
      }
      return delay * (0.98 + 0.02 * chance(random));
    });
    ASSERT_LE(played.oldest_believed, 20.3 * millis) << "seed " << seed;
    believed += played.believed;
  }
  EXPECT_GT(late, 1000);
  EXPECT_GT(believed, 100'000);
}

/// With a delay of any length that stays, no pose is said to be current whose way is longer than 20 millis. What came
/// before the silence was given up for longer than the link bears (100 millis), is no matter.
TEST(LockStep, ADelayThatStaysIsNeverTakenForNone) {
  for (double delay = 1.2 * millis; delay < 0.4; delay += 1.7 * millis) {
    const Played played = play(2, [&](double now) { return now < 0.5 ? millis : delay; });
    const bool is_borne = played.longest_gap < 0.1;
    EXPECT_EQ(is_borne, delay < 20 * millis) << delay;
    if (is_borne) {
      EXPECT_LE(played.oldest_believed, 20.3 * millis);
    }
  }
}

/// After a delay has ended no answer stays on its way: one command to an answer.
TEST(LockStep, AfterADelayOneCommandIsOnItsWay) {
  for (const double delay : {15 * millis, 25 * millis, 49 * millis}) {
    const auto way = [&](double now) { return now > 0.1 && now < 0.4 ? delay : millis; };
    const Played before = play(1, way), after = play(3, way);
    EXPECT_NEAR(after.commands - before.commands, after.believed - before.believed, 2) << delay;
    EXPECT_GT(after.believed - before.believed, 1500);
  }
}

/// A single lost answer, or two in turn, cost less than the link bears.
TEST(LockStep, ALostAnswerIsAPauseAndNoFault) {
  for (const int lost : {1, 2}) {
    int n = 0;
    const Played played = play(5, [&](double) { return ++n % 97 < lost ? never : millis; });
    EXPECT_LT(played.longest_gap, 0.098) << lost;
    EXPECT_GT(played.believed, 1500) << lost;
    EXPECT_LE(played.oldest_believed, 20.3 * millis);
  }
}

/// An answer that nobody asked for: one of a device that speaks unasked tells of now; of any other nobody knows of
/// when.
TEST(LockStep, AnAnswerThatNobodyAskedForIsBelievedOnlyWhereThatIsUsual) {
  for (const bool is_usual : {true, false}) {
    LockStep exchange({.speaks_unasked = is_usual});
    for (int n = 0; n < 5; ++n) exchange.answered(1, n * millis);
    EXPECT_EQ(exchange.is_current(), is_usual);
    EXPECT_TRUE(exchange.is_due(6 * millis));
    exchange.sent(6 * millis);
    EXPECT_FALSE(exchange.is_due(7 * millis));
    exchange.answered(3, 7 * millis);
    EXPECT_EQ(exchange.is_current(), is_usual) << "more than were asked for";
    exchange.restart();
    exchange.sent(8 * millis);
    exchange.answered(1, 9 * millis);
    EXPECT_TRUE(exchange.is_current());
  }
}

}  // namespace
}  // namespace palpate::device
