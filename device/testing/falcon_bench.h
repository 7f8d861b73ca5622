#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <memory>

#include "device/falcon/falcon_driver.h"
#include "device/testing/fake_falcon_link.h"

namespace palpate::device {

/// The driver on the fake, stepped in one thread on the fake's own clock.
struct FalconBench {
  FakeFalconBench fake;
  std::unique_ptr<LinkStylus> stylus;

  explicit FalconBench(const FakeFalconOptions& options = {}, const FalconSettings& settings = {}) : fake(options) {
    LinkStylusOptions link_options;
    link_options.threaded = false;
    stylus = make_falcon_on(
        settings, [this] { return std::make_unique<FakeFalconLink>(fake); }, link_options);
  }

  /// Ticks at 1 kHz of the fake's time; the force is asked for in each.
  void run(double seconds, const std::function<Vec3(const Reading&)>& force) {
    const double end = fake.time + seconds;
    double tick = fake.time;
    while (fake.time < end) {
      stylus->service(0.2e-3);
      if (fake.time < tick) continue;
      tick += 1e-3;
      stylus->write_force(force(stylus->read()));
    }
  }
  void run(double seconds, const Vec3& force = Vec3(0)) {
    run(seconds, [&](const Reading&) { return force; });
  }
  void home() {
    stylus->open();
    run(1.0);
    ASSERT_EQ(stylus->state(), State::idle);
  }
};

}  // namespace palpate::device
