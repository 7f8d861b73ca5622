/// What a link tells of the force on its device, against the device's own force.

#include <gtest/gtest.h>

#include <algorithm>
#include <functional>
#include <memory>
#include <random>

#include "device/testing/link_bench.h"

namespace palpate::device {
namespace {

constexpr double each_s = 1e-3;
constexpr double newtons = 3;

ForceOnDevice told_by(const LinkStylus& stylus) {
  return stylus.force_on_device().value_or(ForceOnDevice{});
}

/// Whatever is asked for, refused, withheld or late: where the force is said to be known, it is the device's; and where
/// the device pushes, it is never said that a zero was taken.
TEST(ForceOnDevice, WhatIsToldIsWhatTheDeviceHas) {
  int known = 0, pushes = 0;
  for (unsigned seed = 0; seed < 100; ++seed) {
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> chance(0, 1);
    LinkBench bench;
    const auto stylus = unthreaded(bench);
    double asked = 0;
    int left = 0;  // exchanges until the device may change its mind
    for (int n = 0; n < 3000; ++n) {
      if (--left < 0) {
        const double kind = chance(random);
        bench.answer = kind < 0.7   ? ForceAnswer::taken
                       : kind < 0.8 ? ForceAnswer::waiting
                       : kind < 0.9 ? ForceAnswer::withheld
                                    : ForceAnswer::refused;
        bench.doubtful = chance(random) < 0.1;
        bench.most_force = chance(random) < 0.1 ? 0.2 : std::numeric_limits<double>::infinity();
        asked = chance(random) < 0.2 ? 0 : 8 * chance(random);
        left = static_cast<int>((bench.answer == ForceAnswer::taken ? 300 : 40) * chance(random));
      }
      if (chance(random) < 0.8) stylus->write_force(Vec3(0, asked, 0));
      stylus->service(each_s);
      const ForceOnDevice told = told_by(*stylus);
      const double has = glm::length(bench.force);
      if (told.state == OnDevice::unknown) continue;
      if (told.state == OnDevice::zero_taken) {
        ASSERT_EQ(has, 0) << "seed " << seed << ", exchange " << n;
      }
      ASSERT_NEAR(told.newtons, has, 1e-12) << "seed " << seed << ", exchange " << n;
      ++known;
      if (has > 0) ++pushes;
    }
  }
  EXPECT_GT(known, 100'000);
  EXPECT_GT(pushes, 10'000);
}

/// A stylus that is lost while it pushes has a force that nobody knows, and the last one is kept. One whose device took
/// a zero, before or after, pushes no more.
TEST(ForceOnDevice, OfALostDeviceItIsKnownOnlyIfAZeroWasTaken) {
  const struct {
    const char* what;
    std::function<void(LinkBench&)> happens;
    LinkFault fault;
    bool takes_zeros;  ///< after it
  } cases[] = {
      {"unplugged", [](LinkBench& bench) { bench.lost = true; }, LinkFault::unplugged, false},
      {"silent", [](LinkBench& bench) { bench.speaks = false; }, LinkFault::silent, false},
      {"refuses", [](LinkBench& bench) { bench.answer = ForceAnswer::refused; }, LinkFault::forces_refused, false},
      {"writes fail", [](LinkBench& bench) { bench.answer = ForceAnswer::waiting; }, LinkFault::forces_refused, false},
      {"slept", [](LinkBench& /*bench*/) { asleep_s += 30; }, LinkFault::slept, true},
      {"brake",
       [](LinkBench& bench) {
         bench.state = State::fault;
         bench.fault = LinkFault::own_safety;
       },
       LinkFault::own_safety, true},
  };
  for (const auto& one : cases) {
    for (const double asked : {0.0, newtons}) {
      LinkBench bench;
      const auto stylus = unthreaded(bench);
      push(bench, *stylus, asked, 0.5);
      ASSERT_EQ(told_by(*stylus).state, asked > 0 ? OnDevice::pushing : OnDevice::zero_taken) << one.what;
      ASSERT_DOUBLE_EQ(told_by(*stylus).newtons, asked) << one.what;
      one.happens(bench);
      for (int n = 0; n < 200; ++n) {
        stylus->write_force(Vec3(0, asked, 0));
        stylus->service(each_s);
      }
      EXPECT_EQ(stylus->fault(), one.fault) << one.what;
      const ForceOnDevice told = told_by(*stylus);
      if (asked == 0 || one.takes_zeros) {
        EXPECT_EQ(told.state, OnDevice::zero_taken) << one.what;
        EXPECT_EQ(told.newtons, 0) << one.what;
      } else {
        EXPECT_NE(told.state, OnDevice::zero_taken) << one.what;
        EXPECT_GT(told.newtons, 0) << one.what;
      }
    }
  }
}

/// After each zero that the link or the driver puts in, until the ramp has ended; and on a trial as long as it lasts.
/// The motors' heat is told elsewhere.
TEST(ForceOnDevice, LessThanAskedIsSaidToBeHeldBack) {
  const struct {
    const char* what;
    std::function<void(LinkBench&, LinkStylus&)> happens;
  } cases[] = {
      {"late servo",
       [](LinkBench& /*bench*/, LinkStylus& stylus) {
         for (int n = 0; n < 40; ++n) stylus.service(each_s);
       }},
      {"doubtful pose",
       [](LinkBench& bench, LinkStylus& stylus) {
         bench.doubtful = true;
         push(bench, stylus, newtons, 0.04);
         bench.doubtful = false;
       }},
      {"withheld",
       [](LinkBench& bench, LinkStylus& stylus) {
         bench.answer = ForceAnswer::withheld;
         push(bench, stylus, newtons, 2 * each_s);
         bench.answer = ForceAnswer::taken;
       }},
  };
  for (const auto& one : cases) {
    LinkBench bench;
    const auto stylus = unthreaded(bench);
    push(bench, *stylus, newtons, 0.5);
    ASSERT_FALSE(told_by(*stylus).is_held_back) << one.what;
    one.happens(bench, *stylus);
    const double began = bench.time;
    double before = 0;
    while (bench.time < began + 0.9 * ceiling::resume_ramp_s) {
      push(bench, *stylus, newtons, 0.5 * each_s);
      const ForceOnDevice told = told_by(*stylus);
      EXPECT_TRUE(told.is_held_back) << one.what << ", " << bench.time - began;
      EXPECT_LT(told.newtons, newtons) << one.what;
      EXPECT_GE(told.newtons, before) << one.what;
      before = told.newtons;
    }
    push(bench, *stylus, newtons, 0.2 * ceiling::resume_ramp_s);
    EXPECT_FALSE(told_by(*stylus).is_held_back) << one.what;
    EXPECT_DOUBLE_EQ(told_by(*stylus).newtons, newtons) << one.what;
  }
  for (const double most : {0.1, 0.2, 2.9}) {
    LinkBench bench;
    const auto stylus = unthreaded(bench);
    push(bench, *stylus, newtons, 0.5);
    bench.most_force = most;
    push(bench, *stylus, newtons, 0.1);
    EXPECT_TRUE(told_by(*stylus).is_held_back);
    EXPECT_DOUBLE_EQ(told_by(*stylus).newtons, most);
    push(bench, *stylus, 0.5 * most, 0.1);
    EXPECT_FALSE(told_by(*stylus).is_held_back) << "nothing more is asked for";
    EXPECT_DOUBLE_EQ(told_by(*stylus).newtons, 0.5 * most);
  }
  LinkBench warm;
  const auto stylus = unthreaded(warm);
  push(warm, *stylus, 8, 20);
  EXPECT_LT(told_by(*stylus).newtons, 5);
  EXPECT_DOUBLE_EQ(told_by(*stylus).newtons, warm.force.y);
  EXPECT_FALSE(told_by(*stylus).is_held_back);
}

/// Nothing is left of before; and what has no motors cannot push.
TEST(ForceOnDevice, OpenedAnewOrWithoutMotorsItIsNone) {
  LinkBench bench;
  const auto stylus = unthreaded(bench);
  push(bench, *stylus, newtons, 0.5);
  bench.lost = true;
  stylus->service(each_s);
  ASSERT_GT(told_by(*stylus).newtons, 0);
  bench.lost = false;
  stylus->open();
  EXPECT_EQ(told_by(*stylus).newtons, 0);
  EXPECT_EQ(told_by(*stylus).state, OnDevice::unknown) << "it may hold the force of before";
  push(bench, *stylus, 0, 0.01);
  EXPECT_EQ(told_by(*stylus).state, OnDevice::zero_taken);

  LinkBench mouse;
  Specification pointing;
  pointing.force_axes = 0;
  LinkStylus hand(pointing, std::make_unique<LinkBenchDriver>(mouse), {.threaded = false, .asleep = &asleep});
  hand.open();
  hand.service(each_s);
  mouse.lost = true;
  hand.service(each_s);
  EXPECT_EQ(told_by(hand).state, OnDevice::zero_taken);
}

}  // namespace
}  // namespace palpate::device
