// Each message of the module's table, as it is said.

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "device/falcon/falcon.h"
#include "device/falcon/falcon_driver.h"
#include "device/falcon/falcon_usb.h"
#include "device/link/hid.h"
#include "device/link/realtime.h"
#include "device/messages.h"
#include "device/safety/guardian.h"
#include "device/safety/safety_filter.h"
#include "device/simulated/hand_path.h"
#include "device/simulated/replay_stylus.h"
#include "device/simulated/simulated_stylus.h"
#include "device/space_mouse/space_mouse.h"
#include "device/testing/fake_hidapi.h"
#include "device/testing/fake_wooden_haptics.h"
#include "device/testing/mishap_link.h"
#include "device/wooden_haptics/wooden_haptics.h"
#include "device/wooden_haptics/wooden_haptics_driver.h"
#include "solver/text/testing/shown.h"

namespace palpate::device {
namespace {

using testing::NotShown;
using testing::output_of;
using testing::Provoked;
using testing::said_when;

std::string file_with(const std::string& name, const std::string& bytes) {
  const std::string file = ::testing::TempDir() + "messages_" + std::to_string(::getpid()) + name;
  std::ofstream(file, std::ios::binary) << bytes;
  return file;
}

const std::vector<std::uint8_t> image(500, 3);

std::string image_file(std::size_t bytes) {
  return file_with("image_" + std::to_string(bytes), std::string(bytes, '\3'));
}

/// Bringing a Falcon up that has no firmware yet.
std::string of_falcon(const std::string& firmware, const std::function<void(FakeFalconBench&)>& before,
                      const std::function<bool(FakeFalconBench&, Packet)>& takes) {
  FakeFalconOptions options;
  options.firmware_loaded = false;
  options.image = image;
  FakeFalconBench bench(options);
  before(bench);
  MishapLink link(bench, [&](Packet packet) { return takes(bench, packet); });
  return said_when([&] { connect_falcon(link, firmware); });
}

bool is_begin(Packet packet) {
  return packet.size() == 1 && packet.front() == 'A';
}
bool is_greeting(Packet packet) {
  return packet.size() == 3 && packet.front() == 0x0a;
}

bool takes_all(FakeFalconBench& /*bench*/, Packet /*packet*/) {
  return true;
}
void as_it_is(FakeFalconBench& /*bench*/) {}

/// An arm that says nothing.
class SilentLink final : public Link {
 public:
  explicit SilentLink(bool unplugged) : unplugged_(unplugged) {}
  double now() noexcept override { return now_; }
  std::size_t receive(std::span<std::uint8_t> /*packet*/, double timeout) noexcept override {
    now_ += timeout;
    return 0;
  }
  bool send(Packet /*packet*/) noexcept override { return true; }
  bool flush(double /*timeout*/) noexcept override { return true; }
  bool lost() const noexcept override { return unplugged_; }

 private:
  double now_ = 0;
  bool unplugged_;
};

std::string of_arm(bool unplugged) {
  SilentLink link(unplugged);
  WoodenHapticsProtocol protocol({});
  return said_when([&] { protocol.connect(link); });
}

/// An arm of 2016 that was named as one of 2015.
std::string of_another_arm() {
  FakeWoodenHapticsOptions options;
  options.report_size = 8;
  FakeWoodenHaptics arm(options);
  FakeHidBench bench;
  FakeHidLink link(arm, bench);
  WoodenHapticsProtocol protocol(wooden_haptics_preset("2015"));
  return said_when([&] { protocol.connect(link); });
}

/// While no more files may be opened.
std::string without_files(const std::function<void()>& run) {
  rlimit before{};
  ::getrlimit(RLIMIT_NOFILE, &before);
  const rlimit none{0, before.rlim_max};
  ::setrlimit(RLIMIT_NOFILE, &none);
  std::string said = said_when(run);
  ::setrlimit(RLIMIT_NOFILE, &before);
  return said;
}

/// While two more files may be opened.
std::string without_files_but_a_pipe(const std::function<void()>& run) {
  const int next = ::dup(0);
  ::close(next);
  rlimit before{};
  ::getrlimit(RLIMIT_NOFILE, &before);
  const rlimit two{static_cast<rlim_t>(next) + 2, before.rlim_max};
  ::setrlimit(RLIMIT_NOFILE, &two);
  std::string said = said_when(run);
  ::setrlimit(RLIMIT_NOFILE, &before);
  return said;
}

/// A Falcon on the first bus, by its number there.
std::string falcon(int number, bool with_node = true) {
  const std::string at = "bus/usb/001/00" + std::to_string(number);
  return "P: /devices/usb1/1-" + std::to_string(number) + "\n" + (with_node ? "N: " + at + "\n" : "") +
         "E: SUBSYSTEM=usb\nE: DRIVER=usb\nE: BUSNUM=001\nE: DEVNUM=00" + std::to_string(number) +
         "\nE: DEVNAME=/dev/" + at +
         "\nE: DEVTYPE=usb_device\nA: bConfigurationValue=1\\n\nA: busnum=1\\n\nA: devnum=" + std::to_string(number) +
         "\\n\nA: speed=12\\n\nH: descriptors=1201000200000040030448cb00050102030109022000010100802d0904000002ffffff00"
         "0705810240000007050202400000\n\n";
}

/// A SpaceMouse with its HID node.
std::string space_mouse() {
  const std::string usb = "/devices/usb1/1-2";
  const std::string name = "0003:046D:C626.0001";
  const std::string hid = usb + "/1-2:1.0/" + name;
  return "P: " + usb +
         "\nN: bus/usb/001/003\nE: DEVNAME=/dev/bus/usb/001/003\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_device\nE: "
         "BUSNUM=001\nE: DEVNUM=003\nA: idVendor=046d\\n\nA: idProduct=c626\\n\nA: busnum=1\\n\nA: devnum=3\\n\n\n"
         "P: " +
         usb + "/1-2:1.0\nE: SUBSYSTEM=usb\nE: DEVTYPE=usb_interface\nA: bInterfaceNumber=00\\n\n\nP: " + hid +
         "\nE: SUBSYSTEM=hid\nE: HID_ID=0003:0000046D:0000C626\nE: HID_NAME=mouse\nE: HID_UNIQ=1\nE: HID_PHYS=fake\n"
         "H: report_descriptor=05010908a10116a2fe265e017510950385010930093109328102c0\n\nP: " +
         hid + "/hidraw/hidraw0\nN: hidraw0=00\nE: SUBSYSTEM=hidraw\nL: device=../../../" + name +
         "\nE: DEVNAME=/dev/hidraw0\nE: MAJOR=246\nE: MINOR=0\n\n";
}

std::string said_of_arm(const std::string& json) {
  // Of an arm that is named, unless the text is no object.
  const std::string named = json.starts_with("{") ? R"({"preset": "2015", )" + json.substr(1) : json;
  return said_when([&] { read_wooden_haptics(file_with("arm.json", named)); });
}

std::string said_of_model(const std::function<void(SimulatedDevice&)>& change) {
  return said_when([&] {
    SimulatedDevice model;
    change(model);
    const SimulatedStylus stylus(model);
  });
}

/// Runs one test of this program.
std::string test_command(const std::string& name) {
  return std::filesystem::read_symlink("/proc/self/exe").string() +
         " --gtest_also_run_disabled_tests --gtest_filter=*" + name;
}

// Not tests of their own: what they print is looked at below.
TEST(MessagesOfStyluses, DISABLED_BecomeRealtime) {
  std::puts(become_realtime(70).advice.c_str());
}
TEST(MessagesOfStyluses, DISABLED_OpenFalcon) {
  std::puts(said_when([] { open_falcon_usb(""); }).c_str());
}
TEST(MessagesOfStyluses, DISABLED_OpenSpaceMouse) {
  std::puts(said_when([] { make_space_mouse({})->open(); }).c_str());
}

/// Root may all, unless it has given that up.
std::string without(const std::string& capabilities) {
  return ::geteuid() == 0 ? "setpriv --bounding-set=" + capabilities : "";
}

std::vector<Provoked> provoke_threads() {
  return {{"no-real-time", output_of("ulimit -r 0; ulimit -l 0; " + without("-sys_nice,-ipc_lock") + " " +
                                     test_command("BecomeRealtime"))}};
}

std::string said_of_guardian(const std::string& program) {
  const auto guardian = start_guardian({program, "toaster", "-"});
  return said_when([&] {
    guardian->prove(program == "/bin/cat" ? 0.05 : Guardian::patience_s);
    guardian->reach();
  });
}

std::string words_of_guardian(GuardianReach reach) {
  GuardianBeat beat;
  beat.reach = reach;
  return Guardian(0, -1, &beat).describe();
}

std::string said_of_second_session() {
  FakeHidApi hid;
  hid.nodes = {{0x1234, 6, 0xffab, 0x200, file_with("arm", ""), L"arm"}};
  const auto first = open_hid(wooden_haptics_hid, hid.nodes[0].path);
  return said_when([&] { open_hid(wooden_haptics_hid, hid.nodes[0].path); });
}

std::vector<Provoked> provoke_devices() {
  const std::string good = image_file(image.size());
  const std::string other = image_file(image.size() - 1);
  // One that reaches no device waits for it until it is ended.
  const auto of_guardian = [](const std::string& arguments) {
    return output_of("PALPATE_LIBDRD=" PALPATE_FAKE_LIBDRD " timeout 4 " + guardian_program() + " " + arguments +
                     " < /dev/null");
  };
  const auto falcon = [&](const std::function<bool(FakeFalconBench&, Packet)>& takes) {
    return of_falcon(good, as_it_is, takes);
  };
  return {
      {"novint-falcon-it-has-no-firmware-since", of_falcon("", as_it_is, takes_all)},
      {"novint-falcon-cannot-be-read", of_falcon("/absent.bin", as_it_is, takes_all)},
      {"novint-falcon-is-too-long", of_falcon(image_file(2'000'000), as_it_is, takes_all)},
      {"novint-falcon-its-serial-chip-refuses", of_falcon(
                                                    good, [](auto& bench) { bench.unplugged = true; }, takes_all)},
      {"novint-falcon-the-firmware-could-not", of_falcon(other, as_it_is, takes_all)},
      {"does-not-run-what-was-uploaded", of_falcon(other, as_it_is, takes_all)},
      {"does-not-answer-the-greeting", of_falcon(
                                           good, [](auto& bench) { bench.falcon.faults.silent = true; }, takes_all)},
      {"does-not-take-the-start", falcon([](auto&, Packet packet) { return !is_begin(packet); })},
      {"does-not-answer-the-start", falcon([](auto& bench, Packet packet) {
         if (is_begin(packet)) bench.falcon.faults.silent = true;
         if (is_greeting(packet)) bench.falcon.faults.silent = false;
         return true;
       })},
      {"does-not-take-byte", falcon([](auto&, Packet packet) { return packet.size() < 60; })},
      {"echo-differs-at-byte", of_falcon(
                                   good, [](auto& bench) { bench.falcon.faults.corrupt_echoes = 1000; }, takes_all)},
      {"was-unplugged", falcon([](auto& bench, Packet packet) {
         bench.unplugged = packet.size() > 60;
         return true;
       })},
      {"woodenhaptics-at-it-was-unplugged", of_arm(true)},
      {"woodenhaptics-at-it-sends-no-reports", of_arm(false)},
      {"guardian-of-the-stylus-cannot-start", said_when([] {
         start_guardian({"/absent", "falcon", ""});
       })},
      {"woodenhaptics-at-it-sends-reports-of-bytes", of_another_arm()},
      {"guardian-of-the-stylus-no-shared-memory", without_files_but_a_pipe([] {
         start_guardian({"/absent", "falcon", ""});
       })},
      {"guardian-of-the-stylus-no-pipe", without_files([] {
         start_guardian({"/absent", "falcon", ""});
       })},
      {"usb-cannot-be-used-here", without_files([] { open_falcon_usb(""); })},
      {"palpate-guardian-the-session-ended-without-closing", of_guardian("force_dimension ''")},
      {"zero-force-was-sent", of_guardian("force_dimension ''")},
      {"stylus-could-not-be-reached", of_guardian("wooden_haptics /absent")},
      {"palpate-guardian-kind-address-is-started", of_guardian("")},
      {"guardian-of-the-stylus-ended", said_of_guardian("/bin/false")},
      {"guardian-of-the-stylus-proves-nothing", said_of_guardian("/bin/cat")},
      {"guardian-of-the-stylus-reaches-nothing", said_of_guardian(guardian_program())},
      {"guardian-reaches-it-at-any-time", words_of_guardian(GuardianReach::at_any_time)},
      {"guardian-reaches-it-once-free", words_of_guardian(GuardianReach::once_free)},
      {"guardian-looks-on", words_of_guardian(GuardianReach::looks_on)},
      {"arm-is-driven-by-another", said_of_second_session()},
  };
}

std::vector<Provoked> provoke_styluses() {
  std::vector<Provoked> said{
      {"settings-cannot-be-read", said_when([] { read_wooden_haptics("/absent.json"); })},
      {"not-a-json-object", said_of_arm("[]")},
      {"not-a-setting", said_of_arm(R"({"color": 3})")},
      {"not-a-usable-setting", said_of_arm(R"({"current_limit": "much"})")},
      {"name-the-arm-as-preset", said_when([] { wooden_haptics_preset("mine"); })},
      {"continuous-current-lies-between-0", said_of_arm(R"({"continuous_current": 3})")},
      {"current-limit-lies-between-0", said_of_arm(R"({"current_limit": 30})")},
      {"calibration-lies-between", said_of_arm(R"({"torque_constant": [0, 1, 1]})")},
      {"forces-would-be-multiplied",
       said_of_arm(R"({"torque_constant": [0.015, 0.015, 0.015], "capstan_diameter": [0.015, 0.015, 0.015]})")},
      {"axis-signs-are-1-or-1", said_of_arm(R"({"force_signs": [1, 2, 1]})")},
      {"encoder-sign-is-1-or-1", said_of_arm(R"({"encoder_sign": [0, 1, 1]})")},
      {"home-counts-must-fit-16-bits", said_of_arm(R"({"home_counts": [99999, 1, 1]})")},
      {"workspace-radius-lies-within-1-m", said_of_arm(R"({"workspace_radius": 3})")},
      {"largest-force-lies-between", said_of_arm(R"({"maximum_force": 90})")},
      {"stiffness-limit-lies-between", said_of_arm(R"({"stiffness_limit": 0})")},
      {"spacemouse-speed-and-full-deflection-must", said_when([] { make_space_mouse({.speed = 0}); })},
      {"no-poses-record-a-session-first", said_when([] { ReplayStylus(std::span<const Reading>()).open(); })},
      {"friction-must-not-be-negative", said_of_model([](auto& model) { model.arm.viscous_friction = -1; })},
      {"masses-must-be-above-zero", said_of_model([](auto& model) { model.arm.mass = 0; })},
      {"hand-spring-and-damper-must-not", said_of_model([](auto& model) { model.hand.damping = -1; })},
      {"rate-must-lie-between-100", said_of_model([](auto& model) { model.rate = 3; })},
      {"delay-must-lie-between-0", said_of_model([](auto& model) { model.delay = 1; })},
      {"maximum-force-and-target-speed-must", said_of_model([](auto& model) { model.maximum_force = 0; })},
      {"position-steps-must-not-be-negative", said_of_model([](auto& model) { model.position_step = -1; })},
      {"simulated-stylus-unplugged", said_when([] {
         SimulatedStylus stylus;
         stylus.inject(SimulatedFault::unplugged);
         stylus.open();
       })},
      {"hand-path-has-no-waypoint", said_when([] { SimulatedStylus().follow({}); })},
      {"waypoint-is-not-finite", said_when([] { check_path(std::array{Waypoint{.position = Vec3(std::nan(""))}}); })},
      {"not-found", said_when([] { open_falcon_usb(""); })},
      {"not-found-list", said_when([] { make_space_mouse({})->open(); })},
      {"woodenhaptics-name-its-address", said_when([] { make_wooden_haptics({}); })},
      {"settings-refused", said_of_arm("[]")},
      {"not-later-than-the-one-before", said_when([] {
         const std::array<Waypoint, 2> path{};
         SimulatedStylus().follow(path);
       })},
  };
  constexpr std::array advice{
      "stylus-reported-a-pose-that-cannot", "scene-asked-for-a-force",   "stylus-is-gone",
      "stylus-stopped-sending-poses",       "no-new-force-was-computed", "servo-loop-was-held-up",
      "stylus-moved-faster-than-allowed",   "panel-stopped-answering"};
  for (std::size_t n = 0; n < advice.size(); ++n) said.push_back({advice[n], advice_for(static_cast<Fault>(n + 1))});
  constexpr std::array link_advice{"link-unplugged",  "link-silent",        "link-slow",     "link-unreachable-pose",
                                   "link-unhomed",    "link-held-up",       "link-slept",    "link-forces-refused",
                                   "link-own-safety", "link-foreign-force", "link-unguarded"};
  for (std::size_t n = 0; n < link_advice.size(); ++n) {
    said.push_back({link_advice[n], advice_for(static_cast<LinkFault>(n + 1))});
  }
  return said;
}

bool has_umockdev() {
#if defined(__SANITIZE_ADDRESS__) || defined(__clang__)  // umockdev's preloaded library does not go with sanitizers
  return false;
#else
  return output_of("umockdev-run --version").find("not found") == std::string::npos;
#endif
}

/// Devices that are there, which nobody answers for.
std::vector<Provoked> provoke_usb() {
  const auto of = [](const std::string& devices, const std::string& test, const std::string& around = "") {
    const std::string record = file_with("record.umockdev", devices);
    return output_of("umockdev-run -d " + record + " -- sh -c \"" + around + " " + test_command(test) + "\"");
  };
  const std::string locked =
      of(falcon(2), "OpenFalcon",
         "chmod 0 \\$UMOCKDEV_DIR/dev/bus/usb/001/002; " + without("-dac_override,-dac_read_search"));
  return {
      {"several-devices", of(falcon(2) + falcon(3), "OpenFalcon")},
      {"cannot-be-opened-replug", of(falcon(2, false), "OpenFalcon")},
      {"novint-falcon-another-program-holds", of(falcon(2), "OpenFalcon")},
      {"permission-denied", locked},
      {"permission-advice", locked},
      {"cannot-be-opened-held", of(space_mouse(), "OpenSpaceMouse")},
  };
}

TEST(MessagesOfStyluses, EachIsShown) {
  std::vector<Provoked> provoked;
  for (const auto& some : {provoke_threads(), provoke_devices(), provoke_styluses()}) {
    provoked.insert(provoked.end(), some.begin(), some.end());
  }
  std::vector<NotShown> not_shown;
  if (has_umockdev()) {
    const std::vector<Provoked> usb = provoke_usb();
    provoked.insert(provoked.end(), usb.begin(), usb.end());
  } else {
    for (const char* const id : {"several-devices", "cannot-be-opened-replug", "novint-falcon-another-program-holds",
                                 "permission-denied", "permission-advice", "cannot-be-opened-held"}) {
      not_shown.push_back({id, "umockdev is not here, or does not go with sanitizers"});
    }
  }
  testing::expect_all_shown({messages::styluses}, provoked, not_shown, PALPATE_SOURCES);
}

}  // namespace
}  // namespace palpate::device
