// Plays the fake devices to an unmodified client through libumockdev: the real libusb and hidapi run in the client.
//   umockdev-wrapper device_umockdev CLIENT KIND SCENARIO
// Ends with 0 when the client did what its scenario says and the last force that the fake saw is zero.

#include <sys/wait.h>
#include <umockdev.h>

#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <functional>
#include <memory>
#include <string>
#include <thread>

#include "palpate/device/internal/fakes/fake_space_mouse.h"
#include "palpate/device/internal/fakes/fake_wooden_haptics.h"
#include "palpate/device/internal/fakes/umockdev_falcon.h"
#include "palpate/device/internal/fakes/umockdev_hid.h"
#include "palpate/device/realtime.h"

namespace {

using namespace palpate::device;

void check(GError* error) {
  if (error == nullptr) return;
  std::fprintf(stderr, "umockdev: %s\n", error->message);
  std::exit(3);
}

/// One fake device on the testbed: what main() has to know of it.
struct Mounted {
  std::function<bool()> is_pushing;
  std::function<unsigned long long()> packets;
  std::string watchdog;  ///< the device's own, for what nobody can reach
  std::string file;      ///< for the client: firmware or settings
};

void write_file(const std::string& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary).write(bytes.data(), static_cast<long>(bytes.size()));
}

Mounted mount_falcon(UMockdevTestbed* testbed, const std::string& scenario, double unplug_after) {
  std::string image(1500, 0);
  for (std::size_t i = 0; i < image.size(); ++i) image[i] = static_cast<char>(i * 7 + i / 251);
  FakeFalconOptions options;
  options.firmware_loaded = scenario != "run";
  options.image.assign(image.begin(), image.end());
  auto falcon = std::make_shared<UmockdevFalcon>(options, unplug_after);
  GError* error = nullptr;
  falcon->attach(testbed, &error);
  check(error);
  const std::string file = "umockdev_falcon_" + scenario + ".bin";
  write_file(file, image);
  return {[falcon] { return falcon->is_pushing(); }, [falcon] { return falcon->commands(); }, "unknown", file};
}

template <typename Fake>
Mounted mount_hid(UMockdevTestbed* testbed, std::shared_ptr<Fake> fake, const UmockdevHidIdentity& identity,
                  double unplug_after, const std::string& watchdog, const std::string& file) {
  auto hid = std::make_shared<UmockdevHid>(*fake, identity, unplug_after);
  GError* error = nullptr;
  hid->attach(testbed, &error);
  check(error);
  return {[fake, hid] { return hid->is_pushing(); }, [hid] { return hid->reports(); }, watchdog, file};
}

Mounted mount_wooden_haptics(UMockdevTestbed* testbed, const std::string& scenario, double unplug_after) {
  FakeWoodenHapticsOptions options;
  const std::array<int, 3>& home = options.arm.home_counts;
  const std::string file = "umockdev_wooden_" + scenario + ".json";
  write_file(file, "{\"address\": \"/dev/hidraw0\", \"home_counts\": [" + std::to_string(home[0]) + ", " +
                       std::to_string(home[1]) + ", " + std::to_string(home[2]) + "]}");
  options.button_time = monotonic_time() + 0.3;
  return mount_hid(testbed, std::make_shared<FakeWoodenHaptics>(options),
                   {"1234", "0006", "WoodenHaptics", "06ABFF0A0002A1017508150026FF00950E09018102950E09029102C0"},
                   unplug_after, "0.5 s", file);
}

Mounted mount_space_mouse(UMockdevTestbed* testbed, double unplug_after) {
  auto puck = std::make_shared<FakeSpaceMouse>(false);
  puck->deflect(Vec3(350, 0, 0));
  // Multi-axis controller; report 1 with X, Y and Z.
  return mount_hid(testbed, puck,
                   {"046d", "c626", "SpaceNavigator", "05010908A10185010930093109321681FE267F01751095038102C0"},
                   unplug_after, "none needed", "-");
}

}  // namespace

int main(int count, char** arguments) {
  if (count != 4) {
    std::fputs("umockdev-wrapper device_umockdev CLIENT KIND SCENARIO\n", stderr);
    return 2;
  }
  const std::string client = arguments[1];
  const std::string kind = arguments[2];
  const std::string scenario = arguments[3];
  const double unplug_after = scenario == "unplug" ? 2.5 : 1e9;
  UMockdevTestbed* const testbed = umockdev_testbed_new();
  const Mounted device = kind == "falcon"           ? mount_falcon(testbed, scenario, unplug_after)
                         : kind == "wooden_haptics" ? mount_wooden_haptics(testbed, scenario, unplug_after)
                                                    : mount_space_mouse(testbed, unplug_after);

  const std::string command = client + " " + kind + " " + scenario + " " + device.file;
  const int status = std::system(command.c_str());
  // The shell reports a client that died of a signal as 128 + its number.
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  const double ended = monotonic_time();
  const bool should_die = scenario == "sigint" || scenario == "sigterm" || scenario == "sigkill";
  // Below the 0.5 s after which a WoodenHaptics arm would help itself.
  while (should_die && device.is_pushing() && monotonic_time() - ended < 0.4) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const double zero_after = monotonic_time() - ended;
  const bool quiet = !device.is_pushing() && zero_after < 0.4;

  std::remove(device.file.c_str());
  std::printf("fake %s: %llu packets, client ended with %d, %s", kind.c_str(), device.packets(), code,
              quiet ? "no force" : "STILL PUSHING");
  if (should_die) std::printf(" %.0f ms after the client was gone", zero_after * 1e3);
  if (scenario == "unplug") std::printf(" (its own watchdog: %s)", device.watchdog.c_str());
  std::puts("");
  const bool ended_well = should_die ? code > 128 : code == 0;
  // An unplugged device is its own watchdog's affair.
  return ended_well && (quiet || scenario == "unplug") && device.packets() > 0 ? 0 : 1;
}
