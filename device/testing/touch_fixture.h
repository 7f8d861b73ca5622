#pragma once

#include <dlfcn.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <functional>
#include <memory>
#include <string>

#include "device/testing/fake_libhd.h"
#include "device/touch/touch_driver.h"

namespace palpate::device {

template <typename Function>
Function function_of_libhd(const char* name) {
  return reinterpret_cast<Function>(dlsym(dlopen(PALPATE_FAKE_LIBHD, RTLD_NOW | RTLD_NODELETE), name));
}

/// The test runs the scheduler's rounds itself, one each millisecond of a clock that only they advance.
class TouchFixture : public ::testing::Test {
 protected:
  TouchFixture() {
    setenv("PALPATE_LIBHD", PALPATE_FAKE_LIBHD, 1);
    hd = function_of_libhd<FakeHd* (*)()>("fake_hd")();
    *hd = FakeHd{};
    function_of_libhd<void (*)(bool)>("fake_hd_by_hand")(true);
  }
  ~TouchFixture() override {
    function_of_libhd<void (*)(bool)>("fake_hd_by_hand")(false);
    unsetenv("PALPATE_LIBHD");
  }

  static void pass(double seconds) noexcept {
    static const auto round = function_of_libhd<void (*)()>("fake_hd_call");
    for (long rounds = std::lround(1e3 * seconds); rounds > 0; --rounds) {
      time += 1e-3;
      round();
    }
  }
  /// A clock for a stylus that waits for samples without rounds: it advances with every reading, so the wait ends.
  static double impatient_now() noexcept { return time += 1e-4; }
  static std::unique_ptr<LinkStylus> unthreaded(const TouchSettings& settings = {}) {
    LinkStylusOptions options;
    options.threaded = false;
    return make_touch_with(settings, options, {&impatient_now, &pass});
  }
  /// Makes exchanges until the condition holds, at most two seconds.
  static bool comes(LinkStylus& stylus, const Vec3& force, const std::function<bool()>& holds) {
    for (int i = 0; i < 2000 && !holds(); ++i) {
      stylus.write_force(force);
      pass(1e-3);
      stylus.service(0);
    }
    return holds();
  }
  Vec3 acting() const { return {hd->force[0], hd->force[1], hd->force[2]}; }
  static void expect_refusal(const std::function<void()>& open, const std::string& why) {
    try {
      open();
      FAIL() << "not refused: " << why;
    } catch (const std::runtime_error& error) {
      EXPECT_THAT(error.what(), ::testing::HasSubstr("3D Systems Touch"));
      EXPECT_THAT(error.what(), ::testing::HasSubstr(why));
    }
  }

  FakeHd* hd = nullptr;
  inline static double time = 0;  // s
};

}  // namespace palpate::device
