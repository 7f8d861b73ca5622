#include <sys/resource.h>
#include <unistd.h>

#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "device/falcon/falcon_driver.h"
#include "device/falcon/falcon_usb.h"
#include "device/link/realtime.h"
#include "device/safety/guardian.h"
#include "device/testing/fake_falcon_link.h"
#include "device/testing/fake_wooden_haptics.h"
#include "device/wooden_haptics/wooden_haptics_driver.h"
#include "plugin/messages/provoked.h"
#include "plugin/messages/provoked_scans.h"
#include "plugin/testing/command_rig.h"

namespace palpate::plugin::testing {
namespace {

using Packet = std::span<const std::uint8_t>;

/// A Falcon's serial chip to which something happens while it is sent to.
class MishapLink final : public device::FalconLink {
 public:
  MishapLink(device::FakeFalconBench& bench, std::function<bool(Packet)> takes)
      : bench_(bench), link_(bench), takes_(std::move(takes)) {}

  double now() noexcept override { return link_.now(); }
  std::size_t receive(std::span<std::uint8_t> packet, double timeout) noexcept override {
    return link_.receive(packet, timeout);
  }
  bool send(Packet packet) noexcept override { return takes_(packet) && link_.send(packet); }
  bool flush(double timeout) noexcept override { return link_.flush(timeout); }
  bool lost() const noexcept override { return link_.lost(); }
  bool control(std::uint8_t request, std::uint16_t value) noexcept override {
    return !bench_.unplugged && link_.control(request, value);
  }

 private:
  device::FakeFalconBench& bench_;
  device::FakeFalconLink link_;
  std::function<bool(Packet)> takes_;
};

const std::vector<std::uint8_t> image(500, 3);

std::string image_file(std::size_t bytes) {
  const auto file = fresh_path("image_" + std::to_string(bytes));
  write_bytes(file, std::string(bytes, '\3'));
  return file.string();
}

/// Bringing a Falcon up that has no firmware yet.
std::string of_falcon(const std::string& firmware, const std::function<void(device::FakeFalconBench&)>& before,
                      const std::function<bool(device::FakeFalconBench&, Packet)>& takes) {
  device::FakeFalconOptions options;
  options.firmware_loaded = false;
  options.image = image;
  device::FakeFalconBench bench(options);
  before(bench);
  MishapLink link(bench, [&](Packet packet) { return takes(bench, packet); });
  return said_when([&] { device::connect_falcon(link, firmware); });
}

bool is_begin(Packet packet) {
  return packet.size() == 1 && packet.front() == 'A';
}
bool is_greeting(Packet packet) {
  return packet.size() == 3 && packet.front() == 0x0a;
}

bool takes_all(device::FakeFalconBench& /*bench*/, Packet /*packet*/) {
  return true;
}
void as_it_is(device::FakeFalconBench& /*bench*/) {}

/// An arm that says nothing.
class SilentLink final : public device::Link {
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
  device::WoodenHapticsProtocol protocol({});
  return said_when([&] { protocol.connect(link); });
}

/// An arm of 2016 that was named as one of 2015.
std::string of_another_arm() {
  device::FakeWoodenHapticsOptions options;
  options.report_size = 8;
  device::FakeWoodenHaptics arm(options);
  device::FakeHidBench bench;
  device::FakeHidLink link(arm, bench);
  device::WoodenHapticsProtocol protocol(device::wooden_haptics_preset("2015"));
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

std::string of_guardian(const std::string& arguments) {
  return output_of(PALPATE_PROGRAM "-guardian " + arguments + " < /dev/null");
}

}  // namespace

std::vector<Provoked> provoke_devices() {
  const std::string good = image_file(image.size());
  const std::string other = image_file(image.size() - 1);
  const std::string node = fresh_path("node").string();
  write_bytes(node, "");
  const auto falcon = [&](const std::function<bool(device::FakeFalconBench&, Packet)>& takes) {
    return of_falcon(good, as_it_is, takes);
  };
  return {
      {"Novint Falcon: it has no firmware since it was switched on; name the firmware file that came with the device "
       "(it is Novint's, and no part of this program)",
       of_falcon("", as_it_is, takes_all)},
      {"Novint Falcon: {} cannot be read{}; name the firmware file that came with the device",
       of_falcon("/absent.bin", as_it_is, takes_all)},
      {"Novint Falcon: {} is too long{}; name the firmware file that came with the device",
       of_falcon(image_file(2'000'000), as_it_is, takes_all)},
      {"Novint Falcon: its serial chip refuses to be set up; unplug it, plug it in again and try once more",
       of_falcon(
           good, [](auto& bench) { bench.unplugged = true; }, takes_all)},
      {"Novint Falcon: the firmware {} could not be uploaded: {}; unplug it, plug it in again and try once more",
       of_falcon(other, as_it_is, takes_all)},
      {"it does not run what was uploaded; is this the Falcon's firmware?", of_falcon(other, as_it_is, takes_all)},
      {"it does not answer the greeting; is its power supply plugged in and switched on?",
       of_falcon(
           good, [](auto& bench) { bench.falcon.faults.silent = true; }, takes_all)},
      {"it does not take the start of the upload", falcon([](auto&, Packet packet) { return !is_begin(packet); })},
      {"it does not answer the start of the upload", falcon([](auto& bench, Packet packet) {
         if (is_begin(packet)) bench.falcon.faults.silent = true;
         if (is_greeting(packet)) bench.falcon.faults.silent = false;
         return true;
       })},
      {"it does not take byte {}", falcon([](auto&, Packet packet) { return packet.size() < 60; })},
      {"its echo differs at byte {}",
       of_falcon(
           good, [](auto& bench) { bench.falcon.faults.corrupt_echoes = 1000; }, takes_all)},
      {"it was unplugged", falcon([](auto& bench, Packet packet) {
         bench.unplugged = packet.size() > 60;
         return true;
       })},
      {"WoodenHaptics at {}: it was unplugged", of_arm(true)},
      {"WoodenHaptics at {}: it sends no reports that it should; is this the device?", of_arm(false)},
      {"guardian of the stylus: cannot start {}: {}; install palpate once more, or name the program in "
       "PALPATE_GUARDIAN",
       said_when([] {
         device::start_guardian({"/absent", "falcon", ""});
       })},
      {"WoodenHaptics at {}: it sends reports of {} bytes, which the preset {} does not have; 2016 is the one with "
       "reports of 8 bytes",
       of_another_arm()},
      {"guardian of the stylus: no shared memory: {}", without_files_but_a_pipe([] {
         device::start_guardian({"/absent", "falcon", ""});
       })},
      {"guardian of the stylus: no pipe: {}", without_files([] {
         device::start_guardian({"/absent", "falcon", ""});
       })},
      {"USB cannot be used here: {}", without_files([] { device::open_falcon_usb(""); })},
      {"palpate-guardian: the session ended without closing its stylus; {}", of_guardian("wooden_haptics " + node)},
      {"zero force was sent", of_guardian("wooden_haptics " + node)},
      {"THE STYLUS COULD NOT BE REACHED: switch it off", of_guardian("wooden_haptics /absent")},
      {"palpate-guardian KIND ADDRESS is started by palpate, never by hand", of_guardian("")},
  };
}

}  // namespace palpate::plugin::testing
