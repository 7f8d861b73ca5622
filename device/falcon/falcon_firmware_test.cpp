#include "device/falcon/falcon_driver.h"

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

#include "device/device_type.h"
#include "device/testing/falcon_bench.h"
#include "device/testing/test_files.h"

namespace palpate::device {
namespace {

using Bench = FalconBench;

std::string write_image(const std::vector<std::uint8_t>& image) {
  static const TestFiles files;
  return files.write("image_" + std::to_string(image.size()), {image.begin(), image.end()});
}

std::vector<std::uint8_t> some_image() {
  std::vector<std::uint8_t> image(7914);
  for (std::size_t i = 0; i < image.size(); ++i) image[i] = static_cast<std::uint8_t>(i * 7 + i / 251);
  return image;
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
    EXPECT_THAT(error.what(), ::testing::HasSubstr("Novint Falcon"));
    EXPECT_THAT(error.what(), ::testing::HasSubstr(reason));
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
  EXPECT_THAT(refusal(R"({"motor_gain": 0})"), ::testing::HasSubstr("the motor gain must be above zero"));
  EXPECT_THAT(refusal(R"({"maximum_force": 13})"), ::testing::HasSubstr("the largest force lies between 0 and 12 N"));
  EXPECT_EQ(refusal(R"({"motor_gain": 9000, "maximum_force": 4})"), "");
}

}  // namespace
}  // namespace palpate::device
