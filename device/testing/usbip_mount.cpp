#include "device/testing/usbip_mount.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <list>
#include <span>
#include <string>
#include <system_error>
#include <thread>

#include "device/link/driver_clock.h"
#include "device/link/realtime.h"
#include "device/testing/fake_usb.h"

namespace palpate::device {

namespace {

// Documentation/usb/usbip_protocol.rst of Linux: frames of 48 bytes, big-endian, data behind them.
constexpr std::uint32_t submit_command = 1;
constexpr std::uint32_t unlink_command = 2;
constexpr std::uint32_t submit_return = 3;
constexpr std::uint32_t unlink_return = 4;
constexpr const char* controller = "/sys/devices/platform/vhci_hcd.0/";
constexpr int port = 0;        // a high-speed hub's, which takes full-speed devices too
constexpr int full_speed = 2;  // enum usb_device_speed
constexpr std::size_t largest_transfer = 1 << 16;

struct Frame {
  std::array<std::uint32_t, 10> words{};  // in this machine's order
  std::array<std::uint8_t, 8> setup{};
};
static_assert(sizeof(Frame) == 48);

bool read_all(int socket, std::span<std::uint8_t> bytes) {
  return bytes.empty() || recv(socket, bytes.data(), bytes.size(), MSG_WAITALL) == static_cast<ssize_t>(bytes.size());
}

bool read_frame(int socket, Frame& frame) {
  if (!read_all(socket, {reinterpret_cast<std::uint8_t*>(&frame), sizeof frame})) return false;
  for (std::uint32_t& word : frame.words) word = ntohl(word);
  return true;
}

void write_to(const std::string& attribute, const std::string& text) {
  const std::string file = controller + attribute;
  const int node = open(file.c_str(), O_WRONLY | O_CLOEXEC);
  const bool written = node >= 0 && write(node, text.data(), text.size()) >= 0;
  const int error = errno;
  if (node >= 0) close(node);
  if (!written) throw std::system_error(error, std::generic_category(), file);
}

}  // namespace

struct UsbipMount::Parts {
  explicit Parts(Play& p) : play(p), device(make_fake_usb(p)) {}

  Play& play;
  std::unique_ptr<FakeUsb> device;
  int socket = -1;
  std::atomic<bool> stop{false};
  std::thread thread;

  struct Read {
    std::uint32_t number;
    std::size_t length;
  };
  std::list<Read> reads;  // IN transfers that wait for the device

  void answer(std::uint32_t kind, std::uint32_t number, int status, std::size_t length,
              std::span<const std::uint8_t> data) const {
    std::vector<std::uint8_t> bytes(48);
    const std::array<std::uint32_t, 7> words{
        kind, number, 0, 0, 0, static_cast<std::uint32_t>(status), static_cast<std::uint32_t>(length)};
    for (std::size_t i = 0; i < words.size(); ++i) {
      const std::uint32_t word = htonl(words[i]);
      std::copy_n(reinterpret_cast<const std::uint8_t*>(&word), 4, bytes.begin() + static_cast<std::ptrdiff_t>(4 * i));
    }
    bytes.insert(bytes.end(), data.begin(), data.end());
    // A kernel that has hung up is found out when it is read from.
    static_cast<void>(send(socket, bytes.data(), bytes.size(), MSG_NOSIGNAL));
  }

  /// False if the kernel has hung up.
  bool take_frame() {
    Frame frame;
    if (!read_frame(socket, frame)) return false;
    const std::uint32_t number = frame.words[1];
    if (frame.words[0] == unlink_command) {
      const auto wanted = [&](const Read& read) { return read.number == frame.words[5]; };
      answer(unlink_return, number, reads.remove_if(wanted) > 0 ? -ECONNRESET : 0, 0, {});
      return true;
    }
    const bool in = frame.words[3] != 0;
    const std::uint32_t endpoint = frame.words[4];
    const std::size_t length = frame.words[6];
    if (frame.words[0] != submit_command || length > largest_transfer) return false;
    std::vector<std::uint8_t> data(in ? 0 : length);
    if (!read_all(socket, data)) return false;
    if (endpoint == 0) {
      const auto& s = frame.setup;
      const UsbSetup setup{s[0], s[1], static_cast<std::uint16_t>(s[2] | s[3] << 8),
                           static_cast<std::uint16_t>(s[4] | s[5] << 8), static_cast<std::uint16_t>(s[6] | s[7] << 8)};
      const std::lock_guard lock(play.mutex);
      const auto reply = answer_control(*device, setup, data, monotonic_time());
      const std::span<const std::uint8_t> bytes = reply && in ? std::span(*reply) : std::span<const std::uint8_t>();
      answer(submit_return, number, reply ? 0 : -EPIPE, in ? bytes.size() : length, bytes);
    } else if (in) {
      reads.push_back({number, length});
    } else {
      const std::lock_guard lock(play.mutex);
      for (std::size_t at = 0; at < length; at += 64) {
        device->write(std::span(data).subspan(at, std::min<std::size_t>(64, length - at)), monotonic_time());
      }
      answer(submit_return, number, 0, length, {});
    }
    return true;
  }

  void finish_reads() {
    const std::lock_guard lock(play.mutex);
    std::array<std::uint8_t, 64> packet{};
    while (!reads.empty()) {
      const auto into = std::span(packet).first(std::min(packet.size(), reads.front().length));
      const auto size = device->read(into, monotonic_time());
      if (!size) return;
      answer(submit_return, reads.front().number, 0, *size, std::span(packet).first(*size));
      reads.pop_front();
    }
  }

  bool unplugged() {
    const std::lock_guard lock(play.mutex);
    return play.unplugged(monotonic_time());
  }

  void attach() {
    std::array<int, 2> ends{};
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
      throw std::system_error(errno, std::generic_category(), "socketpair");
    }
    socket = ends[0];
    constexpr unsigned device_number = 1U << 16 | 2U;
    try {
      write_to("attach", std::to_string(port) + " " + std::to_string(ends[1]) + " " + std::to_string(device_number) +
                             " " + std::to_string(full_speed));
    } catch (const std::system_error&) {
      for (const int end : ends) close(end);
      throw;
    }
    close(ends[1]);  // the kernel holds it by now
  }

  /// Until it is unplugged for good.
  void serve_all() {
    serve();
    while (!stop && play.is_replugged()) {
      {
        const std::lock_guard lock(play.mutex);
        play.lose_usb();
      }
      reads.clear();
      close(socket);
      socket = -1;
      while (!stop && unplugged()) sleep_seconds(1e-3);
      // The kernel lets go of the former one when it gets to it.
      while (!stop && socket < 0) {
        try {
          attach();
        } catch (const std::system_error&) {
          socket = -1;
          sleep_seconds(5e-3);
        }
      }
      serve();
    }
  }

  void serve() {
    while (!stop && !unplugged()) {
      pollfd waiting{socket, POLLIN, 0};
      // Pending transfers are polled as often as a device could have them ready.
      const timespec pause{0, reads.empty() ? 10'000'000 : 200'000};
      const int ready = ppoll(&waiting, 1, &pause, nullptr);
      if (ready > 0 && !take_frame()) break;
      finish_reads();
    }
    shutdown(socket, SHUT_RDWR);
  }
};

UsbipMount::UsbipMount(Play& play) : parts_(std::make_unique<Parts>(play)) {
  parts_->attach();
  parts_->thread = std::thread([this] { parts_->serve_all(); });
}

UsbipMount::~UsbipMount() {
  parts_->stop = true;
  if (parts_->thread.joinable()) parts_->thread.join();
  close(parts_->socket);
}

}  // namespace palpate::device
