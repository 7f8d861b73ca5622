#include "device/safety/stay_awake.h"

#include <gtest/gtest.h>
#include <malloc.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

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

  /// Whether a process that this one has started has not been waited for.
  static bool has_children() {
    siginfo_t info{};
    return waitid(P_ALL, 0, &info, WEXITED | WNOHANG | WNOWAIT) == 0;
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
  EXPECT_TRUE(has_children());
  stylus->close();
  EXPECT_FALSE(has_children()) << "the system may sleep as soon as the stylus is closed";
}

TEST_F(StayAwakeTest, ASessionThatDoesNotSayAsksNothing) {
  FakeFalconBench bench;
  const auto stylus = make_falcon_on({}, [&] { return std::make_unique<FakeFalconLink>(bench); }, {.threaded = false});
  stylus->open();
  EXPECT_FALSE(has_children());
}

/// A program that waits for something else than its input is ended all the same.
TEST_F(StayAwakeTest, OneThatDoesNotHearIsEnded) {
  const TestFiles files;
  const std::string deaf = files.write("systemd-inhibit", "#!/bin/sh\nexec sleep 1000\n");
  chmod(deaf.c_str(), 0755);
  setenv("PATH", (std::filesystem::path(deaf).parent_path().string() + ":" + before_).c_str(), 1);
  auto held = stay_awake("Novint Falcon");
  ASSERT_NE(held, nullptr);
  held.reset();
  EXPECT_FALSE(has_children());
}

TEST_F(StayAwakeTest, LeavesNothingOpen) {
  const auto open_files = [] {
    return std::distance(std::filesystem::directory_iterator("/proc/self/fd"), std::filesystem::directory_iterator());
  };
  const auto before = open_files();
  {
    const auto held = stay_awake("Novint Falcon");
    ASSERT_NE(held, nullptr);
    EXPECT_EQ(open_files(), before + 1) << "the end that is held";
  }
  EXPECT_EQ(open_files(), before);
  setenv("PATH", "/absent", 1);
  EXPECT_EQ(stay_awake("Novint Falcon"), nullptr);
  EXPECT_EQ(open_files(), before);
}

TEST_F(StayAwakeTest, WithoutTheProgramTheSessionGoesOn) {
  setenv("PATH", "/absent", 1);
  const auto fail_often = [] {
    for (int n = 0; n < 20; ++n) EXPECT_EQ(stay_awake("Novint Falcon"), nullptr);
    return mallinfo2().uordblks;
  };
  fail_often();  // what is kept for the next time is there from now on
  const std::size_t before = fail_often();
  EXPECT_LT(fail_often(), before + 20 * 64) << "memory is left";
}

/// What holds the system awake ends with its input: that is this process's, and ends with it however it dies.
TEST_F(StayAwakeTest, ReadsWhatThisProcessHolds) {
  const std::string program = files_.write("systemd-inhibit", "#!/bin/sh\nreadlink /proc/$$/fd/0 >'" + said_ + "'\n");
  chmod(program.c_str(), 0755);
  const auto held = stay_awake("Novint Falcon");
  const std::string input = asked();
  EXPECT_EQ(input.rfind("pipe:", 0), 0U) << input;
  EXPECT_NE(input, std::filesystem::read_symlink("/proc/self/fd/0").string() + "\n");
}

}  // namespace
}  // namespace palpate::device
