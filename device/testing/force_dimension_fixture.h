#pragma once

#include <dlfcn.h>
#include <gtest/gtest.h>

#include <cstdlib>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

#include "device/force_dimension/force_dimension_driver.h"
#include "device/testing/fake_libdrd.h"

namespace palpate::device {

struct Disconnecting {
  void operator()(ForceDimensionDriver* driver) const {
    driver->disconnect();
    delete driver;
  }
};
using ConnectedDriver = std::unique_ptr<ForceDimensionDriver, Disconnecting>;

class ForceDimensionFixture : public ::testing::Test {
 protected:
  ForceDimensionFixture() {
    setenv("PALPATE_LIBDRD", PALPATE_FAKE_LIBDRD, 1);
    void* const library = dlopen(PALPATE_FAKE_LIBDRD, RTLD_NOW | RTLD_NODELETE);
    drd = reinterpret_cast<FakeDrd* (*)()>(dlsym(library, "fake_drd"))();
    *drd = FakeDrd{};
    set_clock = reinterpret_cast<void (*)(double (*)())>(dlsym(library, "fake_drd_set_clock"));
    set_clock([] { return time; });
    set_hook = reinterpret_cast<void (*)(void (*)(const char*))>(dlsym(library, "fake_drd_set_hook"));
  }
  ~ForceDimensionFixture() override {
    set_clock(nullptr);
    set_hook(nullptr);
    unsetenv("PALPATE_LIBDRD");
  }
  static double now() noexcept { return time; }
  static void pass(double seconds) noexcept { time += seconds; }
  static ConnectedDriver connected(const ForceDimensionSettings& settings = {}) {
    ConnectedDriver driver(new ForceDimensionDriver(settings, {&now, &pass}));
    driver->connect();
    return driver;
  }
  static std::string refusal(const std::function<void()>& run) {
    try {
      run();
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "";
  }
  void put(const Vec3& theirs) const {
    for (int i = 0; i < 3; ++i) drd->place[i] = theirs[i];
  }

  FakeDrd* drd = nullptr;
  void (*set_clock)(double (*)()) = nullptr;
  void (*set_hook)(void (*)(const char* call)) = nullptr;
  inline static double time = 0;  // s
};

}  // namespace palpate::device
