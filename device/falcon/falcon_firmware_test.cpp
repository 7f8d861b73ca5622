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
#include <utility>
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
  Bench odd(options, settings);
  odd.fake.falcon.faults.odd_start = true;
  expect_refusal(odd, "does not answer the start");

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
  EXPECT_THAT(refusal(R"({"motor_gain": 0})"),
              ::testing::HasSubstr("'motor_gain' is 0, but lies between 4000 and 25000"));
  EXPECT_THAT(refusal(R"({"maximum_force": 13})"), ::testing::HasSubstr("the largest force lies between 0 and 8 N"));
  EXPECT_EQ(refusal(R"({"motor_gain": 9000, "maximum_force": 4})"), "");
}

using Requests = std::vector<std::pair<int, int>>;

/// Notes FTDI's vendor requests on their way.
class NotedFalconLink final : public FalconLink {
 public:
  NotedFalconLink(FakeFalconBench& bench, Requests& requests) : link_(bench), requests_(requests) {}
  double now() noexcept override { return link_.now(); }
  std::size_t receive(std::span<std::uint8_t> packet, double timeout) noexcept override {
    return link_.receive(packet, timeout);
  }
  bool send(std::span<const std::uint8_t> packet) noexcept override { return link_.send(packet); }
  bool flush(double timeout) noexcept override { return link_.flush(timeout); }
  bool lost() const noexcept override { return link_.lost(); }
  bool control(std::uint8_t request, std::uint16_t value) noexcept override {
    requests_.emplace_back(request, value);
    return link_.control(request, value);
  }

 private:
  FakeFalconLink link_;
  Requests& requests_;
};

/// The serial chip is set as libnifalcon sets it, by libftdi's numbers: reset 0, modem 1, flow control 2, baud 3, data
/// bits 4, latency 9.
TEST(FalconDriver, SetsItsSerialChipAsLibnifalconDoes) {
  const Requests purge{{0, 1}, {0, 2}};
  const Requests run{{9, 1}, {3, 0x0002}, {0, 1}, {0, 2}};
  const Requests greet{{9, 16}, {3, 0x4138}, {4, 8}, {2, 0}, {1, 0x0200}, {1, 0x0100}, {1, 0x0101}};
  const Requests upload{{1, 0x0100}, {3, 0x0015}};
  for (const bool loaded : {true, false}) {
    FakeFalconOptions options;
    options.firmware_loaded = loaded;
    options.image = some_image();
    FakeFalconBench bench(options);
    Requests made;
    NotedFalconLink link(bench, made);
    connect_falcon(link, write_image(options.image));
    Requests wanted = purge;
    const auto add = [&](const Requests& more) { wanted.insert(wanted.end(), more.begin(), more.end()); };
    add(run);
    if (!loaded) {
      for (const Requests& more : {purge, greet, upload, run}) add(more);
    }
    EXPECT_EQ(made, wanted);
  }
}

}  // namespace
}  // namespace palpate::device
