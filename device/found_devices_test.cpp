/// What is plugged in is listed, kind by kind; and where each maker's library is looked for.

#include "device/found_devices.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <map>
#include <string>
#include <vector>

#include "device/device_type.h"
#include "device/force_dimension/drd_library.h"
#include "device/link/realtime.h"
#include "device/link/shared_library.h"
#include "device/testing/fake_falcon.h"
#include "device/testing/fake_hidapi.h"
#include "device/testing/fake_libusb.h"
#include "device/testing/haply_server.h"
#include "device/testing/test_files.h"

namespace palpate::device {
namespace {

std::string why_not(const std::function<void()>& run) {
  try {
    run();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(FoundDevices, AreAllThatArePluggedIn) {
  const TestFiles files;
  FakeUsb usb;
  usb.devices.resize(2);
  FakeHidApi hid;
  hid.nodes = {{0x046d, 0xc626, 1, 8, files.write("puck", ""), L"SpaceNavigator"},
               {0x1234, 0x0006, 0xffab, 0x0200, files.write("arm", ""), L"an arm"}};
  HaplyServer server;
  setenv("PALPATE_HAPLY", ("127.0.0.1:" + std::to_string(server.port())).c_str(), 1);
  setenv("PALPATE_LIBDRD", PALPATE_FAKE_LIBDRD, 1);
  setenv("PALPATE_LIBHD", PALPATE_FAKE_LIBHD, 1);
  std::map<std::string, std::vector<FoundDevice>> found;
  for (const FoundDevice& device : find_devices()) found[device.kind].push_back(device);
  for (const char* const name : {"PALPATE_HAPLY", "PALPATE_LIBDRD", "PALPATE_LIBHD"}) unsetenv(name);
  EXPECT_EQ(found.size(), device_types().size() - 1) << "of each kind but the simulated one";
  for (const auto& [kind, devices] : found) {
    EXPECT_EQ(devices.size(), kind == "falcon" ? 2U : 1U) << kind;
    EXPECT_TRUE(devices[0].accessible) << kind;
    EXPECT_NE(devices[0].name, "") << kind;
    EXPECT_NE(find_device_type(kind), nullptr);
  }
  EXPECT_EQ(found["haply"][0].name, "Haply inverse3");
  EXPECT_EQ(found["touch"][0].address, "") << "the library names none before it is opened";
  EXPECT_EQ(FoundDevice{}.accessible, false);
}

/// Each kind under its own name. Only the simulated one is always there. A kind with a force has zeros to send.
TEST(FoundDevices, EachKindHasItsName) {
  std::string all;
  for (const DeviceType* const type : device_types()) {
    all += (all.empty() ? "" : ", ") + std::string(type->kind);
    EXPECT_EQ(find_device_type(type->kind), type);
    EXPECT_EQ(type->send_zeros != nullptr, type->has_force && type->kind != "simulated") << type->kind;
    EXPECT_EQ(type->find == nullptr, type->kind == "simulated") << type->kind;
    EXPECT_EQ(type->file_hint.empty(), type->file == DeviceFile::none) << type->kind;
  }
  EXPECT_EQ(device_kinds(), all);
  EXPECT_EQ(all.rfind("simulated, falcon, ", 0), 0U);
  EXPECT_FALSE(find_device_type("space_mouse")->has_force);
  EXPECT_EQ(find_device_type("falco"), nullptr);
  EXPECT_EQ(find_device_type(""), nullptr);
}

/// The guardian's zeros to a Falcon: commands of no force that keep its home, until two were answered, also by a serial
/// chip that was plugged in again and has forgotten its speed. Where it is not named, to each that can be opened; and
/// only if all of several were reached does it count.
TEST(FoundDevices, AFalconGetsZerosUntilItAnswersThem) {
  const auto send_zeros = find_device_type("falcon")->send_zeros;
  const std::string zero = "<AAAAAAAAAAAABA>";
  {
    FakeUsb usb;
    FakeFalcon falcon;
    usb.falcon = &falcon;
    falcon.control(3, 0x4138, monotonic_time());
    ASSERT_FALSE(falcon.firmware_runs());
    EXPECT_TRUE(send_zeros("1-3", false));
    EXPECT_TRUE(falcon.firmware_runs());
    EXPECT_GE(falcon.commands(), 2U);
    for (const auto& command : usb.written) EXPECT_EQ(std::string(command.begin(), command.end()), zero);
    EXPECT_FALSE(send_zeros("1-4", false)) << "another";
    EXPECT_TRUE(send_zeros("", false));
    EXPECT_TRUE(usb.holds_nothing());
    falcon.faults.silent = true;
    EXPECT_FALSE(send_zeros("1-3", false)) << "what is not answered is not known to be taken";
  }
  for (const bool locked : {false, true}) {
    FakeUsb usb;
    FakeFalcon falcon;
    usb.falcon = &falcon;
    usb.devices = {{.ports = {1}}, {.ports = {2}, .open_fails = locked ? -3 : 0}, {.ports = {3}}};
    EXPECT_EQ(send_zeros("", false), !locked);
    EXPECT_GE(falcon.commands(), locked ? 4U : 6U) << "one that cannot be opened keeps them from no other";
    EXPECT_FALSE(send_zeros("1-9", false));
  }
  {
    FakeUsb usb;
    usb.devices[0].claim_fails = -6;
    EXPECT_FALSE(send_zeros("", false)) << "the only one is held";
    usb.devices.clear();
    EXPECT_FALSE(send_zeros("", false));
  }
  {
    FakeUsb usb;
    usb.submit_fails = -4;
    EXPECT_FALSE(send_zeros("1-3", false)) << "it does not take them";
  }
}

/// What the guardian says that it can do, before it is needed: nothing where there is no device, no right to it or no
/// maker's library.
TEST(FoundDevices, EachKindSaysWhatItsGuardianCanDo) {
  const auto reach = [](const char* kind, const std::string& address) {
    return find_device_type(kind)->prepare_zeros(address).reach;
  };
  for (const DeviceType* const type : device_types()) {
    EXPECT_EQ(type->prepare_zeros != nullptr, type->send_zeros != nullptr) << type->kind;
  }
  {
    FakeUsb usb;
    EXPECT_EQ(reach("falcon", "1-3"), GuardianReach::at_any_time);
    EXPECT_EQ(reach("falcon", ""), GuardianReach::at_any_time);
    EXPECT_EQ(reach("falcon", "1-4"), GuardianReach::none);
    usb.devices[0].open_fails = -3;
    EXPECT_EQ(reach("falcon", "1-3"), GuardianReach::none) << "no right to it";
  }
  for (const bool is_there : {true, false}) {
    setenv("PALPATE_LIBHD", is_there ? PALPATE_FAKE_LIBHD : "/absent.so", 1);
    setenv("PALPATE_LIBDRD", is_there ? PALPATE_FAKE_LIBDRD : "/absent.so", 1);
    const GuardianReach expected = is_there ? GuardianReach::once_free : GuardianReach::none;
    EXPECT_EQ(reach("touch", ""), expected);
    EXPECT_EQ(reach("force_dimension", "1234"), expected);
  }
  unsetenv("PALPATE_LIBHD");
  unsetenv("PALPATE_LIBDRD");
  EXPECT_EQ(reach("haply", "049D@localhost:1"), GuardianReach::looks_on);
  EXPECT_EQ(reach("wooden_haptics", "/absent"), GuardianReach::none);
}

/// A library is taken from where the environment says, and from nowhere else then; or from the first usual place.
TEST(FoundDevices, ALibraryIsLookedForInItsPlaces) {
  EXPECT_EQ(library_candidates("PALPATE_NONE", {"a", "b"}), (std::vector<std::string>{"a", "b"}));
  setenv("PALPATE_NONE", "", 1);
  EXPECT_EQ(library_candidates("PALPATE_NONE", {"a"}), (std::vector<std::string>{"a"})) << "named by nothing";
  setenv("PALPATE_NONE", "/here.so", 1);
  EXPECT_EQ(library_candidates("PALPATE_NONE", {"a", "b"}), (std::vector<std::string>{"/here.so"}));
  unsetenv("PALPATE_NONE");
  const std::string places[] = {"/absent/first.so", PALPATE_FAKE_LIBHD, "/absent/last.so"};
  const SharedLibrary library("A device", places, "install it");
  EXPECT_EQ(library.file(), PALPATE_FAKE_LIBHD);
  void (*function)() = nullptr;
  library.find("fake_hd", function);
  EXPECT_NE(function, nullptr);
  library.find_if_there("hdNothing", function);
  EXPECT_EQ(function, nullptr);
  EXPECT_EQ(why_not([&] { library.find("hdNothing", function); }),
            std::string("A device: ") + PALPATE_FAKE_LIBHD + " is another version: it has no hdNothing; install it");
  const std::string none[] = {"/absent/first.so", "/absent/last.so"};
  const std::string said = why_not([&] { SharedLibrary("A device", none, "install it"); });
  EXPECT_EQ(said.rfind("A device: its maker's library cannot be loaded (/absent/first.so: ", 0), 0U) << said;
  EXPECT_NE(said.find("; /absent/last.so: "), std::string::npos) << said;
}

/// The SDK's folder, then the user's own.
TEST(FoundDevices, ForceDimensionsLibraryIsInItsSdkOrInTheUsersFolder) {
  const TestFiles files;
  const std::filesystem::path root = std::filesystem::path(files.write("root", "")).parent_path();
  const std::filesystem::path in_sdk = root / "sdk/lib/release/lin-x86_64-gcc/libdrd.so",
                              in_home = root / "home/.local/lib/libdrd.so";
  const std::string home = std::getenv("HOME") != nullptr ? std::getenv("HOME") : "";
  setenv("HOME", (root / "home").c_str(), 1);
  setenv("FDSDK", (root / "sdk").c_str(), 1);
  const std::string said = why_not([] { DrdLibrary(); });
  for (const auto& place : {in_home, in_sdk}) {
    EXPECT_NE(said.find(place), std::string::npos) << "it was looked for there";
    std::filesystem::create_directories(place.parent_path());
    std::filesystem::copy_file(PALPATE_FAKE_LIBDRD, place);
    EXPECT_EQ(DrdLibrary().library.file(), place);
  }
  unsetenv("FDSDK");
  home.empty() ? unsetenv("HOME") : setenv("HOME", home.c_str(), 1);
}

}  // namespace
}  // namespace palpate::device
