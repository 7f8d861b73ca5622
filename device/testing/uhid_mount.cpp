#include "device/testing/uhid_mount.h"

#include <fcntl.h>
#include <linux/input.h>
#include <linux/uhid.h>
#include <poll.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <span>
#include <system_error>
#include <thread>

#include "device/link/driver_clock.h"
#include "device/link/realtime.h"

namespace palpate::device {

struct UhidMount::Parts {
  explicit Parts(Play& p) : play(p), identity(p.hid->identity()) {}

  Play& play;
  HidIdentity identity;
  int node = -1;
  std::atomic<bool> stop{false};
  std::thread thread;
  bool opened = false;

  bool tell(const uhid_event& event) const { return write(node, &event, sizeof event) == sizeof event; }

  bool create() const {
    uhid_event event{};
    event.type = UHID_CREATE2;
    uhid_create2_req& request = event.u.create2;
    std::strncpy(reinterpret_cast<char*>(request.name), identity.name.c_str(), sizeof request.name - 1);
    std::strncpy(reinterpret_cast<char*>(request.phys), "usb-fake-1/input0", sizeof request.phys - 1);
    std::copy(identity.report_descriptor.begin(), identity.report_descriptor.end(), request.rd_data);
    request.rd_size = static_cast<__u16>(identity.report_descriptor.size());
    request.bus = BUS_USB;
    request.vendor = identity.vendor;
    request.product = identity.product;
    return tell(event);
  }

  void take_event() {
    uhid_event event{};
    if (read(node, &event, sizeof event) <= 0) return;
    if (event.type == UHID_OPEN) opened = true;
    if (event.type == UHID_CLOSE) opened = false;
    if (event.type == UHID_OUTPUT && event.u.output.size > 0) {
      const std::lock_guard lock(play.mutex);
      // uhid hands on the report's number also where reports have none.
      const auto bytes = std::span<const std::uint8_t>(event.u.output.data, event.u.output.size);
      play.hid->write(bytes.subspan(identity.numbers_reports ? 0 : 1), monotonic_time());
    }
  }

  void send_reports() {
    const std::lock_guard lock(play.mutex);
    const double now = monotonic_time();
    play.touch(now);
    std::array<std::uint8_t, 64> report{};
    while (const auto size = play.hid->read(report, now)) {
      uhid_event event{};
      event.type = UHID_INPUT2;
      event.u.input2.size = static_cast<__u16>(*size);
      std::copy_n(report.begin(), *size, event.u.input2.data);
      tell(event);
    }
  }

  bool unplugged() {
    const std::lock_guard lock(play.mutex);
    return play.unplugged(monotonic_time());
  }

  void serve() {
    while (!stop && !unplugged()) {
      pollfd waiting{node, POLLIN, 0};
      const timespec pause{0, opened ? 200'000 : 10'000'000};
      if (ppoll(&waiting, 1, &pause, nullptr) > 0) take_event();
      // Reports are requested only from an opened device.
      if (opened) send_reports();
    }
    uhid_event event{};
    event.type = UHID_DESTROY;
    tell(event);
    opened = false;
  }

  /// Until it is unplugged for good.
  void serve_all() {
    serve();
    while (!stop && play.is_replugged()) {
      while (!stop && unplugged()) sleep_seconds(1e-3);
      create();
      serve();
    }
  }
};

UhidMount::UhidMount(Play& play) : parts_(std::make_unique<Parts>(play)) {
  parts_->node = open("/dev/uhid", O_RDWR | O_CLOEXEC);
  if (parts_->node < 0 || !parts_->create()) throw std::system_error(errno, std::generic_category(), "/dev/uhid");
  parts_->thread = std::thread([this] { parts_->serve_all(); });
}

UhidMount::~UhidMount() {
  parts_->stop = true;
  if (parts_->thread.joinable()) parts_->thread.join();
  close(parts_->node);
}

}  // namespace palpate::device
