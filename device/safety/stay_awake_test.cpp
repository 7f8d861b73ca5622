#include "device/safety/stay_awake.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <thread>

#include "device/falcon/falcon_driver.h"
#include "device/link/link_stylus.h"
#include "device/testing/fake_falcon_link.h"
#include "device/testing/test_files.h"

namespace palpate::device {
namespace {

std::string content_of(const std::string& file) {
  std::ifstream stream(file);
  return {std::istreambuf_iterator<char>(stream), {}};
}

/// A program of systemd-inhibit's name that says what it was asked, and for how long it was held.
class StayAwakeTest : public ::testing::Test {
 protected:
  StayAwakeTest() : before_(std::getenv("PATH")) {
    const std::string program =
        files_.write("systemd-inhibit", "#!/bin/sh\necho \"$@\" >'" + said_ + "'\nwhile read line; do :; done\n");
    chmod(program.c_str(), 0755);
    setenv("PATH", (std::filesystem::path(program).parent_path().string() + ":" + before_).c_str(), 1);
  }
  ~StayAwakeTest() override { setenv("PATH", before_.c_str(), 1); }

  /// What was asked, waiting for it at most two seconds.
  std::string asked() const {
    for (int i = 0; i < 200 && content_of(said_).empty(); ++i) {
      std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return content_of(said_);
  }

  std::string before_;
  TestFiles files_;
  std::string said_ = files_.write("said", "");
};

TEST_F(StayAwakeTest, ASessionWithMotorsAsksTheSystemNotToSleep) {
  FakeFalconBench bench;
  LinkStylusOptions options;
  options.threaded = false;
  options.stays_awake = true;
  const auto stylus = make_falcon_on(
      {}, [&] { return std::make_unique<FakeFalconLink>(bench); }, options);
  stylus->open();
  EXPECT_EQ(asked(), "--what=sleep:idle --mode=block --who=Palpate --why=Novint Falcon is held cat\n");
  stylus->close();
}

TEST_F(StayAwakeTest, WithoutTheProgramTheSessionGoesOn) {
  setenv("PATH", "/absent", 1);
  EXPECT_EQ(stay_awake("Novint Falcon"), nullptr);
}

}  // namespace
}  // namespace palpate::device
