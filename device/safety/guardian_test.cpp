#include "device/safety/guardian.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <chrono>
#include <filesystem>
#include <string>
#include <thread>

#include "device/testing/test_files.h"

namespace palpate::device {
namespace {

using std::chrono::milliseconds;

std::uintmax_t size_of(const std::string& file) {
  std::error_code failed;
  const auto size = std::filesystem::file_size(file, failed);
  return failed ? 0 : size;
}

/// Bytes in the file after at most a second of waiting for some.
std::uintmax_t written(const std::string& file) {
  for (int i = 0; i < 100 && size_of(file) == 0; ++i) std::this_thread::sleep_for(milliseconds(10));
  return size_of(file);
}

/// An arm's node is a file here: what the guardian writes stays in it.
struct Node {
  TestFiles files;
  std::string path = files.write("node", "");
  std::unique_ptr<Guardian> guardian = start_guardian({guardian_program(), "wooden_haptics", path});
};

TEST(Guardian, IsFoundBesideTheTests) {
  EXPECT_NE(guardian_program().find("palpate-guardian"), std::string::npos);
}

TEST(Guardian, SendsZerosWhereASessionStandsStillWhileItPushes) {
  testing::internal::CaptureStderr();
  Node node;
  ASSERT_TRUE(node.guardian);
  for (int i = 0; i < 50; ++i) {
    node.guardian->beat(true);
    std::this_thread::sleep_for(milliseconds(10));
  }
  EXPECT_EQ(size_of(node.path), 0U) << "while it lives it is left alone";
  EXPECT_GT(written(node.path), 0U);
  node.guardian->dismiss();
  EXPECT_NE(testing::internal::GetCapturedStderr().find(
                "palpate-guardian: the session stands still while it pushes; zero force was sent"),
            std::string::npos);
}

TEST(Guardian, LeavesASessionAloneThatPushesNothing) {
  Node node;
  node.guardian->beat(false);
  std::this_thread::sleep_for(milliseconds(500));
  EXPECT_EQ(size_of(node.path), 0U);
}

TEST(Guardian, LeavesADeviceAloneThatWasClosed) {
  Node node;
  node.guardian->beat(true);
  node.guardian->dismiss();
  std::this_thread::sleep_for(milliseconds(300));
  EXPECT_EQ(size_of(node.path), 0U);
}

TEST(Guardian, SendsZerosToADeviceThatComesBack) {
  Node node;
  std::filesystem::remove(node.path);
  node.guardian->hand_over();
  std::this_thread::sleep_for(milliseconds(100));
  node.files.write("node", "");
  EXPECT_GT(written(node.path), 0U);
}

}  // namespace
}  // namespace palpate::device
