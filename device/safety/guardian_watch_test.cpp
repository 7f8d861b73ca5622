#include "device/safety/guardian_watch.h"

#include <gtest/gtest.h>

namespace palpate::device {
namespace {

/// What a session does between two looks.
struct WatchedSession {
  GuardianBeat beat;
  GuardianWatch watch{&beat};

  void exchange(bool pushing) {
    beat.on_device = pushing ? OnDevice::pushing : OnDevice::zero_taken;
    ++beat.count;
  }
};

constexpr int enough = GuardianWatch::looks_until_stopped;

TEST(GuardianWatch, AForceIsLeftAloneForTwoTenthsOfASecond) {
  EXPECT_EQ(GuardianWatch::look_every_ms * GuardianWatch::looks_until_stopped, 200);
  EXPECT_LE(GuardianWatch::look_every_ms, 100) << "it lives for its session to see 10 times a second";
}

/// From the last look at which the session had gone on.
TEST(GuardianWatch, SaysThatAForceIsKeptForAsLongAsItIsKept) {
  for (const int exchanges : {1, 2, 1000}) {
    WatchedSession session;
    for (int n = 0; n < exchanges; ++n) {
      session.exchange(true);
      EXPECT_FALSE(session.watch.stopped()) << "it goes on";
    }
    for (int look = 1; look <= 5 * enough; ++look) {
      EXPECT_EQ(session.watch.stopped(), look >= enough) << look;
      EXPECT_EQ(session.watch.stopped_just_now(), look == enough) << look;
    }
  }
}

TEST(GuardianWatch, LeavesASessionAloneThatGoesOnOrPushesNothing) {
  for (const int looks_between : {1, 2, enough}) {
    WatchedSession session;
    for (int look = 0; look < 1000; ++look) {
      if (look % looks_between == 0) session.exchange(true);
      EXPECT_FALSE(session.watch.stopped());
    }
  }
  WatchedSession idle;
  for (int look = 0; look < 1000; ++look) EXPECT_FALSE(idle.watch.stopped()) << "before any exchange";
  idle.exchange(false);
  for (int look = 0; look < 1000; ++look) EXPECT_FALSE(idle.watch.stopped());
}

/// What was seen before it went on does not count.
TEST(GuardianWatch, BeginsAnewWhereTheSessionGoesOn) {
  for (int seen = 0; seen < 3 * enough; ++seen) {
    WatchedSession session;
    session.exchange(true);
    for (int look = 0; look < seen; ++look) session.watch.stopped();
    session.exchange(true);
    for (int look = 0; look <= enough; ++look) EXPECT_EQ(session.watch.stopped(), look == enough) << seen;
    EXPECT_TRUE(session.watch.stopped_just_now());
  }
}

TEST(GuardianWatch, NothingSharedIsNothingStopped) {
  GuardianWatch watch(nullptr);
  for (int look = 0; look < 1000; ++look) EXPECT_FALSE(watch.stopped());
  EXPECT_FALSE(watch.stopped_just_now());
}

}  // namespace
}  // namespace palpate::device
