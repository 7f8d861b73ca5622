// Plays the fake devices to an unmodified client through libumockdev: the real libusb and hidapi run in the client.
//   umockdev-wrapper device_umockdev CLIENT KIND SCENARIO
// Ends with 0 when the client did what its scenario says and the last force that the fake saw is zero.

#include <sys/wait.h>
#include <umockdev.h>

#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <string>
#include <thread>
#include <vector>

#include "palpate/device/internal/fakes/umockdev_falcon.h"
#include "palpate/device/realtime.h"

namespace {

using namespace palpate::device;

void check(GError* error) {
  if (error == nullptr) return;
  std::fprintf(stderr, "umockdev: %s\n", error->message);
  std::exit(3);
}

std::vector<std::uint8_t> some_image() {
  std::vector<std::uint8_t> image(1500);
  for (std::size_t i = 0; i < image.size(); ++i) image[i] = static_cast<std::uint8_t>(i * 7 + i / 251);
  return image;
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
  UMockdevTestbed* testbed = umockdev_testbed_new();

  const std::vector<std::uint8_t> image = some_image();
  const std::string image_file = "umockdev_falcon_" + scenario + ".bin";
  std::ofstream(image_file, std::ios::binary)
      .write(reinterpret_cast<const char*>(image.data()), static_cast<long>(image.size()));
  FakeFalconOptions options;
  options.firmware_loaded = scenario != "run";
  options.image = image;
  UmockdevFalcon falcon(options, scenario == "unplug" ? 2.0 : 1e9);
  GError* error = nullptr;
  falcon.attach(testbed, &error);
  check(error);

  const std::string command = client + " " + kind + " " + scenario + " " + image_file;
  const int status = std::system(command.c_str());
  // The shell reports a client that died of a signal as 128 + its number.
  const int code = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
  const double ended = monotonic_time();
  const bool should_die = scenario == "sigint" || scenario == "sigterm" || scenario == "sigkill";
  while (should_die && falcon.is_pushing() && monotonic_time() - ended < 2) {
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  const double zero_after = monotonic_time() - ended;

  std::remove(image_file.c_str());
  std::printf("fake falcon: %llu commands, client ended with %d, %s", falcon.commands(), code,
              falcon.is_pushing() ? "STILL PUSHING" : "no force");
  if (should_die) std::printf(" %.0f ms after the client was gone", zero_after * 1e3);
  std::puts("");
  const bool ended_well = should_die ? code > 128 : code == 0;
  // What a Falcon does when its plug is pulled is its own watchdog's affair, which nobody has documented.
  const bool quiet = scenario == "unplug" || !falcon.is_pushing();
  return ended_well && quiet && falcon.commands() > 0 ? 0 : 1;
}
