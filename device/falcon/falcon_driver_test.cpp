#include "device/falcon/falcon_driver.h"
#include "device/device_type.h"
#include "device/testing/test_files.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <functional>
#include <glm/geometric.hpp>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "device/testing/fake_falcon_link.h"
#include "device/testing/wall_ringing.h"

namespace palpate::device {
namespace {

/// The driver on the fake, stepped in one thread on the fake's own clock.
struct Bench {
  FakeFalconBench fake;
  std::unique_ptr<LinkStylus> stylus;

  explicit Bench(const FakeFalconOptions& options = {}, const FalconSettings& settings = {}) : fake(options) {
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

std::string write_image(const std::vector<std::uint8_t>& image) {
  static const TestFiles files;
  return files.write("image_" + std::to_string(image.size()), {image.begin(), image.end()});
}

std::vector<std::uint8_t> some_image() {
  std::vector<std::uint8_t> image(7914);
  for (std::size_t i = 0; i < image.size(); ++i) image[i] = static_cast<std::uint8_t>(i * 7 + i / 251);
  return image;
}

TEST(FalconDriver, HomesAndThenKnowsWhereTheGripIs) {
  Bench bench;
  bench.stylus->open();
  EXPECT_EQ(bench.stylus->state(), State::homing);
  bench.run(0.2, [&](const Reading& reading) {
    EXPECT_EQ(reading.position, Vec3(0)) << "no pose before homing";
    return Vec3(0, 2, 0);
  });
  EXPECT_FALSE(bench.fake.falcon.is_pushing()) << "no force before homing";
  EXPECT_EQ(bench.fake.falcon.pushed_until(), 0);
  bench.run(0.8);
  ASSERT_EQ(bench.stylus->state(), State::idle);
  const Vec3 grip = bench.fake.falcon.hand().body().position;
  EXPECT_LT(glm::length(bench.stylus->read().position - grip), 0.1e-3);
  EXPECT_EQ(bench.fake.falcon.packets_with_other_size(), 0);
}

TEST(FalconDriver, ExchangesAlmostAThousandPacketsASecond) {
  Bench bench;
  bench.home();
  const std::uint64_t before = bench.fake.falcon.commands();
  int fresh = 0;
  bench.run(1, [&](const Reading& reading) {
    fresh += reading.fresh ? 1 : 0;
    return Vec3(0);
  });
  EXPECT_GT(bench.fake.falcon.commands() - before, 900U);
  EXPECT_LE(bench.fake.falcon.commands() - before, 1100U);
  EXPECT_GT(fresh, 850);
}

TEST(FalconDriver, TheGripFeelsTheForceAskedFor) {
  Bench bench;
  bench.home();
  for (const Vec3& force : {Vec3(1, 0, 0), Vec3(0, -2, 0), Vec3(0.5, 0.5, -1)}) {
    bench.run(0.5, force);
    EXPECT_LT(glm::length(bench.fake.falcon.force() - force), 0.01);
    EXPECT_GT(glm::dot(bench.stylus->read().position, force), 0) << "the simulated hand relaxes";
  }
}

/// How far the hand still moves on a wall of this stiffness (N/m), m.
double ringing(double stiffness, double friction) {
  FakeFalconOptions options;
  options.friction = friction;
  options.path = {{0.05, {0, 0, 0}}, {0.30, {0, 0, 0.039}}, {0.60, {0, 0.005, 0}}, {1.2, {0, -0.002, 0}}};
  Bench bench(options);
  bench.home();
  return ringing_of_wall(bench, bench.fake.falcon.hand(), stiffness);
}

TEST(FalconDriver, AWallAtItsStiffnessLimitIsQuiet) {
  const double limit = Bench().stylus->specification().stiffness_limit;
  EXPECT_LT(ringing(limit, 0.06), 0.15e-3) << "tremor alone";
  // Whatever a real one's friction: without any, a stiffer wall lets less of the tremor through, until it rings.
  EXPECT_LT(ringing(limit, 0), ringing(limit / 2, 0));
  EXPECT_LT(ringing(1.5 * limit, 0), ringing(limit, 0)) << "and there is a margin";
  EXPECT_GT(ringing(2 * limit, 0), 3 * ringing(limit, 0)) << "or nothing could be seen here";
}

TEST(FalconDriver, AHugeForceSaturatesInItsDirection) {
  Bench bench;
  bench.home();
  bench.run(0.05, Vec3(300, 400, 0));
  const Vec3 felt = bench.fake.falcon.force();
  int largest = 0;
  for (const int motor : bench.fake.falcon.motors()) largest = std::max(largest, std::abs(motor));
  EXPECT_EQ(largest, falcon_motor_limit);
  EXPECT_GT(glm::length(felt), 5) << "about 6 N is what the motors can do sideways, at the gain that is assumed";
  EXPECT_LE(glm::length(felt), 8.01);
  EXPECT_NEAR(glm::dot(glm::normalize(felt), Vec3(0.6, 0.8, 0)), 1, 1e-3);
  bench.run(0.01, Vec3(std::numeric_limits<double>::quiet_NaN(), 0, 0));
  EXPECT_FALSE(bench.fake.falcon.is_pushing());
}

/// A dead pose is told by this alone: what was read is not fresh when it is read again.
TEST(FalconDriver, APoseIsFreshOnce) {
  Bench bench;
  bench.home();
  int fresh = 0;
  bench.run(0.5, [&](const Reading& reading) {
    fresh += reading.fresh ? 1 : 0;
    const Reading again = bench.stylus->read();
    EXPECT_FALSE(again.fresh);
    EXPECT_EQ(again.position, reading.position);
    return Vec3(0);
  });
  EXPECT_GT(fresh, 400);
  bench.fake.falcon.faults.silent = true;
  bench.run(0.002);
  bench.stylus->read();
  bench.run(0.05, [&](const Reading& reading) {
    EXPECT_FALSE(reading.fresh);
    return Vec3(0);
  });
}

/// No safety filter here, and motors that could do three times as much: what limits is the driver.
TEST(FalconDriver, HoldsItsOwnForceLimit) {
  FalconSettings settings;
  settings.maximum_force = 2;
  Bench bench({}, settings);
  bench.home();
  EXPECT_EQ(bench.stylus->specification().maximum_force, 2);
  for (const Vec3& force : {Vec3(1, 0, 1), Vec3(3, 0, 0), Vec3(0, -2.5, 1), Vec3(1e6, 1e6, -1e6), Vec3(0, 0, 2.2)}) {
    bench.run(0.05, force);
    const Vec3 expected = force * std::min(1.0, 2 / glm::length(force));
    EXPECT_LT(glm::length(bench.fake.falcon.force() - expected), 0.02) << force.x << ' ' << force.y << ' ' << force.z;
  }
  EXPECT_LT(glm::length(bench.fake.falcon.strongest_force()), 2.02);
}

TEST(FalconDriver, UploadsTheFirmwareItIsGiven) {
  FakeFalconOptions options;
  options.firmware_loaded = false;
  options.image = some_image();
  for (const bool zero : {false, true}) {
    options.greeting_after_zero = zero;
    FalconSettings settings;
    settings.firmware_file = write_image(options.image);
    Bench bench(options, settings);
    bench.stylus->open();
    EXPECT_TRUE(bench.fake.falcon.firmware_runs());
    EXPECT_EQ(bench.fake.falcon.uploads(), 1);
    bench.run(1);
    EXPECT_EQ(bench.stylus->state(), State::idle);
  }
}

TEST(FalconDriver, StartsTheUploadAgainWhenTheEchoDiffers) {
  FakeFalconOptions options;
  options.firmware_loaded = false;
  options.image = some_image();
  FalconSettings settings;
  settings.firmware_file = write_image(options.image);
  Bench bench(options, settings);
  bench.fake.falcon.faults.corrupt_echoes = 1;
  bench.stylus->open();
  EXPECT_EQ(bench.fake.falcon.uploads(), 2);
  EXPECT_TRUE(bench.fake.falcon.firmware_runs());
}

void expect_refusal(Bench& bench, const std::string& reason) {
  try {
    bench.stylus->open();
    FAIL() << "not refused: " << reason;
  } catch (const std::runtime_error& error) {
    EXPECT_THAT(error.what(), testing::HasSubstr("Novint Falcon"));
    EXPECT_THAT(error.what(), testing::HasSubstr(reason));
  }
  EXPECT_EQ(bench.stylus->state(), State::disconnected);
}

TEST(FalconDriver, SaysWhatIsMissing) {
  FakeFalconOptions options;
  options.firmware_loaded = false;
  options.image = some_image();
  Bench no_file(options);
  expect_refusal(no_file, "name the firmware file");

  FalconSettings settings;
  settings.firmware_file = "/nonexistent/firmware";
  Bench no_such_file(options, settings);
  expect_refusal(no_such_file, "/nonexistent/firmware cannot be read");

  settings.firmware_file = write_image({1, 2, 3});
  Bench wrong_image(options, settings);
  expect_refusal(wrong_image, "does not run what was uploaded");

  settings.firmware_file = write_image(some_image());
  Bench silent(options, settings);
  silent.fake.falcon.faults.silent = true;
  const double begun = silent.fake.time;
  expect_refusal(silent, "is its power supply plugged in");
  EXPECT_LT(silent.fake.time - begun, 3) << "s that the caller waits";
}

TEST(FalconDriver, AStalledServoIsAnsweredWithZeros) {
  Bench bench;
  bench.home();
  bench.run(0.1, Vec3(1, 0, 0));
  const double stalled = bench.fake.time;
  while (bench.fake.time < stalled + 0.2) bench.stylus->service(1e-3);  // no read, no write
  EXPECT_FALSE(bench.fake.falcon.is_pushing());
  EXPECT_LT(bench.fake.falcon.pushed_until() - stalled, 0.023);
  EXPECT_EQ(bench.stylus->state(), State::idle);
}

TEST(FalconDriver, ClosingLeavesZeros) {
  Bench bench;
  bench.home();
  bench.run(0.1, Vec3(1, 0, 0));
  ASSERT_TRUE(bench.fake.falcon.is_pushing());
  bench.stylus->close();
  EXPECT_FALSE(bench.fake.falcon.is_pushing());
  EXPECT_EQ(bench.stylus->state(), State::disconnected);
  bench.stylus->close();
  bench.stylus->open();  // still homed: the Falcon has not been told otherwise
  bench.run(0.1, Vec3(1, 0, 0));
  ASSERT_TRUE(bench.fake.falcon.is_pushing());
  bench.stylus.reset();
  EXPECT_FALSE(bench.fake.falcon.is_pushing()) << "the destructor closes";
}

TEST(FalconDriver, SplitRepliesLoseNothing) {
  for (const std::size_t most : {1U, 5U, 15U}) {
    Bench bench;
    bench.home();
    bench.fake.falcon.faults.most_payload = most;
    int fresh = 0;
    bench.run(0.5, [&](const Reading& reading) {
      fresh += reading.fresh ? 1 : 0;
      return Vec3(0, 0.5, 0);
    });
    EXPECT_EQ(bench.stylus->state(), State::idle);
    EXPECT_GT(fresh, 20) << most;
    EXPECT_LT(glm::length(bench.fake.falcon.force() - Vec3(0, 0.5, 0)), 0.01);
  }
}

TEST(FalconDriver, LostAndGarbledRepliesAreAskedForAgain) {
  Bench bench;
  bench.home();
  bench.fake.falcon.faults.drop_every = 37;
  bench.fake.falcon.faults.garble_every = 53;
  int fresh = 0;
  double worst_gap = 0;
  double last = 0;
  bench.run(2, [&](const Reading& reading) {
    if (reading.fresh) {
      ++fresh;
      if (last > 0) worst_gap = std::max(worst_gap, reading.time - last);
      last = reading.time;
    }
    return Vec3(0);
  });
  EXPECT_EQ(bench.stylus->fault(), LinkFault::none) << name_of(bench.stylus->fault());
  EXPECT_GT(fresh, 800);
  EXPECT_LT(worst_gap, 0.05);
}

TEST(FalconDriver, NoReplyStaysInThePipeAfterADelay) {
  // Late answers must not leave the driver one exchange behind for ever.
  Bench bench;
  bench.home();
  bench.fake.falcon.faults.reply_delay = 0.030;
  bench.run(0.3);
  bench.fake.falcon.faults.reply_delay = 0;
  bench.run(0.3);
  const std::uint64_t before = bench.fake.falcon.commands();
  bench.run(1);
  EXPECT_LE(bench.fake.falcon.commands() - before, 1100U) << "two in flight would be up to 2000";
}

TEST(FalconDriver, AnImpossiblePoseIsAFaultAndNoForce) {
  Bench bench;
  bench.home();
  bench.run(0.1, Vec3(1, 0, 0));
  bench.fake.falcon.faults.impossible_pose = true;
  const double start = bench.fake.time;
  bench.run(0.1, [](const Reading& reading) {
    EXPECT_LT(glm::length(reading.position), 0.1);
    return Vec3(1, 0, 0);
  });
  EXPECT_EQ(bench.stylus->state(), State::fault);
  EXPECT_EQ(bench.stylus->fault(), LinkFault::unreachable_pose);
  EXPECT_FALSE(bench.fake.falcon.is_pushing());
  EXPECT_LT(bench.fake.falcon.pushed_until() - start, 3e-3);
  bench.fake.falcon.faults.impossible_pose = false;
  bench.run(0.1, Vec3(1, 0, 0));
  EXPECT_EQ(bench.stylus->state(), State::fault) << "until it is opened again";
}

TEST(FalconDriver, APoseBeyondTheReachIsHeldWithoutForceUntilItIsBack) {
  Bench bench;
  bench.home();
  bench.run(0.1, Vec3(1, 0, 0));
  const Vec3 before = bench.stylus->read().position;
  bench.fake.falcon.faults.impossible_pose = true;
  bench.run(0.02, Vec3(1, 0, 0));
  EXPECT_LT(glm::distance(bench.stylus->read().position, before), 1e-3);
  EXPECT_FALSE(bench.fake.falcon.is_pushing());
  bench.fake.falcon.faults.impossible_pose = false;
  bench.run(0.05, Vec3(1, 0, 0));
  EXPECT_EQ(bench.stylus->state(), State::idle);
  EXPECT_TRUE(bench.fake.falcon.is_pushing());
}

TEST(FalconSettings, WrongOnesAreRefusedByName) {
  const TestFiles files;
  const auto refusal = [&](const std::string& json) -> std::string {
    try {
      find_device_type("falcon")->make({.settings = files.write("falcon.json", json)});
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return {};
  };
  EXPECT_THAT(refusal(R"({"motor_gain": 0})"), testing::HasSubstr("the motor gain must be above zero"));
  EXPECT_THAT(refusal(R"({"maximum_force": 13})"), testing::HasSubstr("the largest force lies between 0 and 12 N"));
  EXPECT_EQ(refusal(R"({"motor_gain": 9000, "maximum_force": 4})"), "");
}

TEST(FalconDriver, UnpluggedAndSilentAreFaults) {
  Bench unplugged;
  unplugged.home();
  unplugged.fake.unplugged = true;
  unplugged.run(0.01, Vec3(1, 0, 0));
  EXPECT_EQ(unplugged.stylus->fault(), LinkFault::unplugged);
  unplugged.stylus->close();

  Bench silent;
  silent.home();
  silent.run(0.1, Vec3(1, 0, 0));
  silent.fake.falcon.faults.silent = true;
  silent.run(0.2, Vec3(1, 0, 0));
  EXPECT_EQ(silent.stylus->fault(), LinkFault::silent);
  silent.fake.falcon.faults.silent = false;
  silent.run(0.1, Vec3(1, 0, 0));
  EXPECT_EQ(silent.stylus->state(), State::fault);
  EXPECT_FALSE(silent.fake.falcon.is_pushing()) << "a device that comes back gets zeros";
}

TEST(FalconDriver, WorksWithItsOwnThread) {
  // The same driver, threaded: the fake's clock races ahead of the real one, so only outcomes count here.
  FakeFalconBench fake;
  LinkStylusOptions options;
  options.force_age = 1e9;
  auto stylus = make_falcon_on(
      {}, [&] { return std::make_unique<FakeFalconLink>(fake); }, options);
  stylus->open();
  for (int i = 0; i < 5000 && stylus->state() != State::idle; ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  ASSERT_EQ(stylus->state(), State::idle);
  for (int i = 0; i < 50; ++i) {
    EXPECT_LT(glm::length(stylus->read().position), 0.06);
    stylus->write_force(Vec3(0, 0, 1));
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  stylus->close();
  EXPECT_GT(fake.falcon.pushed_until(), 0);
  EXPECT_FALSE(fake.falcon.is_pushing());
}

}  // namespace
}  // namespace palpate::device
