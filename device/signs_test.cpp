/// The signs of a settings file, from the file to the device: of every kind with motors, on its fake, with its own
/// thread. And that each asks the system not to sleep.

#include <dlfcn.h>
#include <gtest/gtest.h>
#include <sys/stat.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <glm/geometric.hpp>
#include <iterator>
#include <memory>
#include <string>
#include <thread>

#include "device/device_type.h"
#include "device/link/realtime.h"
#include "device/testing/fake_falcon.h"
#include "device/testing/fake_hidapi.h"
#include "device/testing/fake_libdrd.h"
#include "device/testing/fake_libhd.h"
#include "device/testing/fake_libusb.h"
#include "device/testing/fake_wooden_haptics.h"
#include "device/testing/haply_server.h"
#include "device/testing/test_files.h"

namespace palpate::device {
namespace {

/// Writes a force a thousand times a second as long as something does not hold, at most ten seconds. As urgently as a
/// servo does: the force of one that is late is taken away, and comes up again along the ramp.
bool comes_to(Stylus& stylus, const Vec3& force, const std::function<bool(const Reading&)>& holds) {
  bool comes = false;
  std::thread servo([&] {
    make_thread_realtime(50);
    for (const double begun = monotonic_time(); !comes && monotonic_time() - begun < 10;) {
      stylus.write_force(force);
      comes = holds(stylus.read());
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  });
  servo.join();
  return comes;
}

/// A vector that one thread writes and another reads.
class Told {
 public:
  void operator=(const Vec3& v) {
    for (int i = 0; i < 3; ++i) v_[static_cast<std::size_t>(i)] = v[i];
  }
  operator Vec3() const { return {v_[0].load(), v_[1].load(), v_[2].load()}; }

 private:
  std::array<std::atomic<double>, 3> v_{};
};

template <typename State>
State* state_of(const char* file, const char* name) {
  return reinterpret_cast<State* (*)()>(dlsym(dlopen(file, RTLD_NOW | RTLD_NODELETE), name))();
}

class Signs : public ::testing::Test {
 protected:
  Signs() : path_(std::getenv("PATH")) {
    const std::string program =
        files.write("systemd-inhibit", "#!/bin/sh\necho \"$@\" >>'" + held_ + "'\nwhile read line; do :; done\n");
    chmod(program.c_str(), 0755);
    setenv("PATH", (std::filesystem::path(program).parent_path().string() + ":" + path_).c_str(), 1);
  }
  ~Signs() override { setenv("PATH", path_.c_str(), 1); }

  std::shared_ptr<Stylus> made(const char* kind, const std::string& more = "") const {
    const std::string json = R"({"guarded": false, "position_signs": [-1, 1, -1], "force_signs": [1, -1, -1])";
    const auto stylus = find_device_type(kind)->make({.settings = files.write("signs.json", json + more + "}")});
    stylus->open();
    return stylus;
  }
  /// With a pose and a force of which each axis is another, until both are as the file has them.
  void expect_turned(Stylus& stylus, const Vec3& place, const std::function<Vec3()>& acting, double about_n) const {
    // A hand that holds a fake gives way by force over its stiffness: 1 mm.
    const Vec3 asked(0.2, 0.3, -0.4), acts(0.2, -0.3, 0.4);
    EXPECT_TRUE(comes_to(stylus, asked,
                         [&](const Reading& reading) {
                           return glm::distance(reading.position, place * Vec3(-1, 1, -1)) < 3e-3 &&
                                  glm::distance(acting(), acts) < about_n;
                         }))
        << stylus.specification().name << ": " << glm::distance(stylus.read().position, place * Vec3(-1, 1, -1));
    std::string said;
    comes_to(stylus, asked, [&](const Reading&) {
      std::ifstream held(held_);
      said = {std::istreambuf_iterator<char>(held), {}};
      return !said.empty();
    });
    EXPECT_NE(said.find("--why=" + stylus.specification().name + " is held"), std::string::npos) << said;
  }

  TestFiles files;

 private:
  std::string path_;
  std::string held_ = files.write("held", "");
};

TEST_F(Signs, OfATouch) {
  setenv("PALPATE_LIBHD", PALPATE_FAKE_LIBHD, 1);
  FakeHd* const hd = state_of<FakeHd>(PALPATE_FAKE_LIBHD, "fake_hd");
  *hd = FakeHd{};
  for (int i = 0; i < 3; ++i) hd->place_mm[i] = 10 * (i + 1);
  const auto stylus = made("touch");
  expect_turned(
      *stylus, {0.01, 0.02, 0.03}, [&] { return Vec3(hd->force[0], hd->force[1], hd->force[2]); }, 1e-9);
  stylus->close();
  unsetenv("PALPATE_LIBHD");
}

TEST_F(Signs, OfAForceDimension) {
  setenv("PALPATE_LIBDRD", PALPATE_FAKE_LIBDRD, 1);
  FakeDrd* const drd = state_of<FakeDrd>(PALPATE_FAKE_LIBDRD, "fake_drd");
  *drd = FakeDrd{};
  for (int i = 0; i < 3; ++i) drd->place[i] = 0.01 * (i + 1);
  const auto stylus = made("force_dimension");
  // Theirs: x towards the user, y right, z up.
  expect_turned(
      *stylus, {0.02, 0.03, 0.01}, [&] { return Vec3(drd->force[1], drd->force[2], drd->force[0]); }, 1e-9);
  stylus->close();
  unsetenv("PALPATE_LIBDRD");
}

TEST_F(Signs, OfAHaply) {
  FakeHaply service;
  service.place = {0.01, 0.02, 0.03};
  HaplyServer server(service);
  const auto stylus = made("haply", R"(, "host": "127.0.0.1", "port": )" + std::to_string(server.port()));
  // Theirs: x right, y away from the user, z up.
  expect_turned(
      *stylus, {0.01, 0.03, -0.02},
      [&] {
        const Vec3 theirs = server.acting();
        return Vec3(theirs.x, theirs.z, -theirs.y);
      },
      1e-4);
}

TEST_F(Signs, OfAFalcon) {
  FakeFalconOptions options;
  options.homed = true;
  options.path = {{0, {0.01, 0.02, -0.015}}};
  FakeFalcon falcon(options);
  FakeUsb usb;
  usb.falcon = &falcon;
  Told force;
  usb.on_write = [&] { force = falcon.force(); };
  const auto stylus = made("falcon");
  expect_turned(
      *stylus, {0.01, 0.02, -0.015}, [&] { return Vec3(force); }, 0.05);
  stylus->close();
}

TEST_F(Signs, OfAWoodenArm) {
  FakeWoodenHapticsOptions options;
  options.button_time = 0.05;  // in its home pose, which is the origin
  options.path = {{0.1, Vec3(0)}, {0.25, {0.01, 0.02, -0.03}}};
  FakeWoodenHaptics arm(options);
  std::string home;
  for (const int counts : options.arm.home_counts) home += (home.empty() ? "" : ", ") + std::to_string(counts);
  FakeHidApi hid;
  hid.nodes = {{0x1234, 0x0006, 0xffab, 0x0200, files.write("node", ""), L"arm", true, &arm}};
  Told force;
  hid.on_write = [&] { force = arm.force(); };
  const auto stylus = made("wooden_haptics", R"(, "preset": "2015", "address": ")" + hid.nodes[0].path +
                                                 R"(", "home_counts": [)" + home + "]");
  expect_turned(
      *stylus, {0.01, 0.02, -0.03}, [&] { return Vec3(force); }, 0.05);
  stylus->close();
}

}  // namespace
}  // namespace palpate::device
