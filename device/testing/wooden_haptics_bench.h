#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "device/testing/fake_wooden_haptics.h"
#include "device/testing/link_bench.h"
#include "device/wooden_haptics/wooden_haptics_driver.h"

namespace palpate::device {

/// The driver on the fake, stepped in one thread on the fake's own clock.
struct WoodenHapticsBench {
  FakeHidBench bench;
  FakeWoodenHaptics arm;
  std::unique_ptr<LinkStylus> stylus;

  explicit WoodenHapticsBench(const FakeWoodenHapticsOptions& options = {}) : arm(options) {
    LinkStylusOptions link_options;
    link_options.threaded = false;
    link_options.asleep = &asleep;
    stylus = make_wooden_haptics_on(
        options.arm, [this] { return std::make_unique<FakeHidLink>(arm, bench); }, link_options);
  }
  void run(double seconds, const std::function<Vec3(const Reading&)>& force) {
    const double end = bench.time + seconds;
    double tick = bench.time;
    while (bench.time < end) {
      stylus->service(0.2e-3);
      if (bench.time < tick) continue;
      tick += 1e-3;
      stylus->write_force(force(stylus->read()));
    }
  }
  void run(double seconds, const Vec3& force = Vec3(0)) {
    run(seconds, [&](const Reading&) { return force; });
  }
  bool is_pushing() const { return arm.is_pushing(bench.time); }
  void home() {
    stylus->open();
    run(0.3);
    ASSERT_EQ(stylus->state(), State::idle);
  }
};

}  // namespace palpate::device
