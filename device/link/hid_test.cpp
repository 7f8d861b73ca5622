/// HID devices among the test's own, against what hidapi says of its functions.

#include "device/link/hid.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <filesystem>
#include <fstream>
#include <functional>
#include <random>
#include <string>
#include <vector>

#include "device/device_type.h"
#include "device/space_mouse/space_mouse_driver.h"
#include "device/testing/fake_hidapi.h"
#include "device/testing/test_files.h"
#include "device/wooden_haptics/wooden_haptics_driver.h"

namespace palpate::device {
namespace {

std::string hid_refusal(const std::function<void()>& open) {
  try {
    open();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

class Hid : public ::testing::Test {
 protected:
  /// A node that this user may open.
  FakeHidNode puck(const std::string& file = "hidraw0") const {
    return {0x046d, 0xc626, 0x0001, 0x0008, files.write(file, ""), L"SpaceNavigator"};
  }
  FakeHidNode arm(const std::string& file = "hidraw1") const {
    return {0x1234, 0x0006, 0xffab, 0x0200, files.write(file, ""), L"WoodenHaptics"};
  }

  TestFiles files;
  FakeHidApi hid;
};

/// A kind is told by all of vendor, product, usage page and usage: with any of them off by one it is another device.
TEST_F(Hid, AKindIsToldByAllThatADeviceSaysOfItself) {
  FakeHidNode teensy = arm("hidraw2");
  teensy.vendor = 0x16c0;
  teensy.product = 0x0486;
  for (const FakeHidNode& known : {puck(), arm(), teensy}) {
    const bool is_puck = known.name == L"SpaceNavigator";
    hid.nodes = {known};
    EXPECT_EQ(find_device_type("space_mouse")->find().size(), is_puck ? 1U : 0U);
    EXPECT_EQ(find_device_type("wooden_haptics")->find().size(), is_puck ? 0U : 1U);
    for (const auto part : {&FakeHidNode::vendor, &FakeHidNode::product, &FakeHidNode::page, &FakeHidNode::usage}) {
      for (const int by : {-2, -1, 2}) {
        FakeHidNode other = known;
        other.*part = static_cast<std::uint16_t>(other.*part + by);
        if (is_puck && part == &FakeHidNode::product && by != -2) continue;  // 0xc625 and 0xc628 are pucks, too
        hid.nodes = {other};
        EXPECT_TRUE(find_device_type("space_mouse")->find().empty());
        EXPECT_TRUE(find_device_type("wooden_haptics")->find().empty());
      }
    }
  }
  EXPECT_EQ(hid.lists, 0);
}

TEST_F(Hid, ListsEachNodeOnceWithItsNameAndWhetherItMayBeOpened) {
  FakeHidNode odd = arm("hidraw4");
  odd.name = L"Arm\u00e9 \x1f~\x7f";
  FakeHidNode mute = arm("hidraw5");
  mute.name = L"";
  FakeHidNode locked = arm();
  locked.path = "/absent/hidraw9";
  hid.nodes = {arm(), puck(), arm(), odd, mute, locked, odd};
  const auto found = find_device_type("wooden_haptics")->find();
  ASSERT_EQ(found.size(), 4U);
  const char* const names[] = {"WoodenHaptics", "Arm? ?~?", "", "WoodenHaptics"};
  const std::string paths[] = {arm().path, odd.path, mute.path, locked.path};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(found[i].kind, "wooden_haptics");
    EXPECT_EQ(found[i].name, names[i]);
    EXPECT_EQ(found[i].address, paths[i]);
    EXPECT_EQ(found[i].accessible, i < 3);
    EXPECT_THAT(found[i].note, ::testing::HasSubstr(i < 3 ? "make sure that it is one" : "udev"));
  }
  EXPECT_EQ(find_device_type("space_mouse")->find().at(0).note, "");
  EXPECT_EQ(hid.lists, 0);
  hid.starts = false;
  EXPECT_TRUE(find_device_type("wooden_haptics")->find().empty());
}

TEST_F(Hid, OpensTheOneThatIsMeantOrSaysWhyNot) {
  hid.nodes = {puck("hidraw0"), puck("hidraw1"), arm("hidraw2")};
  open_hid(space_mouse_hid, hid.nodes[1].path);
  EXPECT_EQ(hid.opened, hid.nodes[1].path);
  open_hid(wooden_haptics_hid, "");
  EXPECT_EQ(hid.opened, hid.nodes[2].path);
  EXPECT_EQ(hid.handles, 0) << "closed with the link";
  using ::testing::StartsWith;
  EXPECT_THAT(hid_refusal([] { open_hid(space_mouse_hid, ""); }), StartsWith("SpaceMouse: there are 2; name"));
  EXPECT_THAT(hid_refusal([] { open_hid(space_mouse_hid, "/dev/hidraw7"); }),
              StartsWith("SpaceMouse at /dev/hidraw7: not found"));
  hid.nodes[2].opens = false;
  EXPECT_EQ(hid_refusal([] { open_hid(wooden_haptics_hid, ""); }),
            "WoodenHaptics: cannot be opened: a fault of the f?ke?; does another program hold it?");
  hid.nodes[2].path = "/absent";
  EXPECT_THAT(hid_refusal([] { open_hid(wooden_haptics_hid, "/absent"); }),
              StartsWith("WoodenHaptics at /absent: permission denied; type: sudo cp "));
  hid.nodes.clear();
  EXPECT_THAT(hid_refusal([] { open_hid(wooden_haptics_hid, ""); }), StartsWith("WoodenHaptics: not found"));
}

/// Reports come whole; hidapi waits by the millisecond, and so no shorter than it is told to.
TEST_F(Hid, ReceivesWhatComesAndWaitsNoShorterThanItIsTold) {
  std::mt19937 random(1);
  hid.nodes = {arm()};
  const auto link = open_hid(wooden_haptics_hid, "");
  std::array<std::uint8_t, 64> packet{};
  for (const std::size_t size : {1U, 8U, 14U, 64U}) {
    std::vector<std::uint8_t> report(size);
    for (auto& byte : report) byte = static_cast<std::uint8_t>(random());
    hid.input.push_back({report});
    ASSERT_EQ(link->receive(packet, 0), size);
    EXPECT_TRUE(std::equal(report.begin(), report.end(), packet.begin()));
  }
  hid.waits_ms.clear();
  for (const double wait_s : {0.0, 0.2e-3, 1e-3, 1.1e-3, 0.0495, 2.0}) EXPECT_EQ(link->receive(packet, wait_s), 0U);
  EXPECT_EQ(hid.waits_ms, (std::vector<int>{0, 1, 1, 2, 50, 2000}));
  EXPECT_FALSE(link->lost()) << "nothing came";
}

/// A read that a signal broke off is no unplugging, whatever failed before; any other failure is one, for good.
TEST_F(Hid, IsLostWhereAReadFails) {
  hid.nodes = {arm()};
  const auto link = open_hid(wooden_haptics_hid, "");
  std::array<std::uint8_t, 64> packet{};
  const std::vector<std::uint8_t> report(14, 7);
  for (int n = 0; n < 30; ++n) {
    hid.input.push_back({{}, EINTR});
    errno = EIO;
    EXPECT_EQ(link->receive(packet, 0), 0U);
    EXPECT_FALSE(link->lost());
    EXPECT_TRUE(link->send(report));
  }
  EXPECT_TRUE(link->flush(0));
  hid.input.push_back({{}, EIO});
  EXPECT_EQ(link->receive(packet, 0), 0U);
  EXPECT_TRUE(link->lost());
  EXPECT_FALSE(link->flush(0));
  EXPECT_FALSE(link->send(report));
  const std::size_t asked = hid.waits_ms.size();
  hid.input.push_back({report});
  EXPECT_EQ(link->receive(packet, 0), 0U) << "it stays so";
  EXPECT_EQ(hid.waits_ms.size(), asked);
  EXPECT_EQ(hid.written.size(), 30U);
}

/// hidapi reports a device that is gone without saying why: a read that fails with errno as it was before is one, too.
TEST_F(Hid, IsLostThoughAnEarlierCallWasBrokenOff) {
  hid.nodes = {arm()};
  const auto link = open_hid(wooden_haptics_hid, "");
  std::array<std::uint8_t, 64> packet{};
  hid.input.push_back({.failed = FakeHidInput::without_errno});
  errno = EINTR;
  EXPECT_EQ(link->receive(packet, 0), 0U);
  EXPECT_TRUE(link->lost());
}

/// A report is written behind the number 0. One that does not fit is not; a write that fails is told and survived.
TEST_F(Hid, WritesReportsBehindTheirNumber) {
  hid.nodes = {arm()};
  const auto link = open_hid(wooden_haptics_hid, "");
  for (const std::size_t size : {0U, 1U, 14U, 64U}) {
    std::vector<std::uint8_t> report(size);
    for (std::size_t i = 0; i < size; ++i) report[i] = static_cast<std::uint8_t>(i + 1);
    EXPECT_TRUE(link->send(report));
    report.insert(report.begin(), 0);
    EXPECT_EQ(hid.written.back(), report);
  }
  EXPECT_FALSE(link->send(std::vector<std::uint8_t>(65)));
  hid.takes = false;
  EXPECT_FALSE(link->send(std::vector<std::uint8_t>(14)));
  EXPECT_FALSE(link->lost());
  hid.takes = true;
  EXPECT_TRUE(link->send(std::vector<std::uint8_t>(14)));
}

/// The kernel's files on hidraw nodes: the four lines that tell a device, among others.
class HidFiles {
 public:
  void write(const std::string& node, const std::array<std::string, 4>& lines, const std::string& driver) const {
    const std::filesystem::path folder = root_ / "class/hidraw" / node / "device";
    std::filesystem::create_directories(folder);
    std::ofstream uevent(folder / "uevent");
    uevent << "DRIVER=" << driver << "\n";
    for (const std::string& line : lines) uevent << line << "\n";
    uevent << "MODALIAS=hid:b0003g0001v00001234p00000006\n";
  }
  std::string identity(const std::string& path) const { return hid_identity(path, root_); }

 private:
  TestFiles files_;
  std::filesystem::path root_ = std::filesystem::path(files_.write("root", "")).parent_path();
};

/// Two devices differ in their ids, name, socket or serial number, and often in one of them alone. A device that gets
/// another node or driver is the same one.
TEST(HidIdentity, IsOfTheDeviceAndNotOfItsNode) {
  const std::array<std::string, 4> arm{"HID_ID=0003:00001234:00000006", "HID_NAME=WoodenHaptics",
                                       "HID_PHYS=usb-0000:00:14.0-1/input0", "HID_UNIQ=17"};
  const HidFiles files;
  files.write("hidraw0", arm, "hid-generic");
  const std::string identity = files.identity("/dev/hidraw0");
  EXPECT_NE(identity, "");
  files.write("hidraw3", arm, "hid-other");
  EXPECT_EQ(files.identity("/dev/hidraw3"), identity);
  for (std::size_t line = 0; line < arm.size(); ++line) {
    std::array<std::string, 4> other = arm;
    other[line].back() = '9';
    files.write("hidraw0", other, "hid-generic");
    EXPECT_NE(files.identity("/dev/hidraw0"), identity) << arm[line];
  }
  EXPECT_EQ(files.identity("/dev/hidraw7"), "");
  EXPECT_EQ(files.identity("hidraw3"), "") << "no path";
}

/// One by the settings' address, and only with one: other devices have its ids.
TEST_F(Hid, AnArmHasToBeNamed) {
  WoodenHapticsSettings settings = wooden_haptics_preset("2015");
  EXPECT_THAT(hid_refusal([&] { make_wooden_haptics(settings); }), ::testing::HasSubstr("name its address"));
  settings.guarded = false;
  settings.address = "/dev/hidraw3";
  EXPECT_THAT(hid_refusal([&] { make_wooden_haptics(settings)->open(); }),
              ::testing::StartsWith("WoodenHaptics at /dev/hidraw3: not found"));
  EXPECT_THAT(hid_refusal([] { make_space_mouse({.address = "/dev/hidraw4"})->open(); }),
              ::testing::StartsWith("SpaceMouse at /dev/hidraw4: not found"));
}

}  // namespace
}  // namespace palpate::device
