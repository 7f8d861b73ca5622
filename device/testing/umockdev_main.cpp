// Plays the fake devices to an unmodified client through libumockdev: the real libusb and hidapi run in the client.
//   umockdev-wrapper device_umockdev CLIENT KIND SCENARIO
// Exit code 0 if the client does what its scenario requires and the last force at the fake is zero.

#include <umockdev.h>

#include <cstdio>
#include <exception>

#include "device/link/realtime.h"
#include "device/testing/play.h"
#include "device/testing/umockdev_falcon.h"
#include "device/testing/umockdev_hid.h"

namespace {

template <typename Mount>
int run_on(palpate::device::Play& play, const char* client) {
  GError* error = nullptr;
  UMockdevTestbed* const testbed = umockdev_testbed_new();
  Mount mount(play);
  mount.attach(testbed, &error);
  if (error != nullptr) {
    std::fprintf(stderr, "umockdev: %s\n", error->message);
    return 3;
  }
  return play.run(client);
}

}  // namespace

int main(int count, char** arguments) {
  using namespace palpate::device;
  if (count != 4) {
    std::fputs("umockdev-wrapper device_umockdev CLIENT KIND SCENARIO\n", stderr);
    return 2;
  }
  // Above the client's threads, and all of them above everything else on this machine, if that is permitted: a real
  // device is not late because the machine is busy.
  make_thread_realtime(65);
  try {
    Play play({.kind = arguments[2], .name = arguments[3], .address = "/dev/hidraw0"});
    return play.falcon ? run_on<UmockdevFalcon>(play, arguments[1]) : run_on<UmockdevHid>(play, arguments[1]);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "device_umockdev: %s\n", error.what());
    return 2;
  }
}
