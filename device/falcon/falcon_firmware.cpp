// Bringing a Falcon up, after libnifalcon (BSD): first the serial chip, then, where it has none, the firmware.

#include <algorithm>
#include <fstream>
#include <iterator>
#include <stdexcept>

#include "device/falcon/falcon_driver.h"
#include "device/link/lock_step.h"
#include "device/messages.h"

namespace palpate::device {

namespace {

// Further vendor requests of FTDI.
constexpr std::uint8_t modem = 1;
constexpr std::uint8_t flow_control = 2;
constexpr std::uint8_t baud = 3;
constexpr std::uint8_t framing = 4;
constexpr std::uint8_t latency = 9;

constexpr std::uint16_t purge_sent = 2;
constexpr std::uint16_t dtr_low = 0x0100;
constexpr std::uint16_t dtr_high = 0x0101;
constexpr std::uint16_t rts_low = 0x0200;
constexpr std::uint16_t baud_9600 = 0x4138;
constexpr std::uint16_t baud_140k = 0x0015;
constexpr std::uint16_t baud_1500k = 0x0002;
constexpr std::uint16_t eight_n_one = 0x0008;

constexpr std::size_t chunk = 62;               // what one USB packet carries beside the chip's two status bytes
constexpr double greeting_patience = 1.5;       // s
constexpr double upload_patience = 15.0;        // s: an image takes less than one
constexpr std::size_t largest_image = 1 << 20;  // images seen are 7 to 9 kB

struct Request {
  std::uint8_t request;
  std::uint16_t value;
};

void configure(FalconLink& link, std::initializer_list<Request> requests) {
  for (const Request& request : requests) {
    if (!link.control(request.request, request.value)) {
      throw Refusal(say("novint-falcon-its-serial-chip-refuses"));
    }
  }
}

bool send_now(Link& link, std::span<const std::uint8_t> bytes) {
  return link.flush(0.2) && link.send(bytes) && link.flush(0.2);
}

/// Collects bytes until `wanted` of them are there or the time is over.
std::vector<std::uint8_t> receive_bytes(Link& link, std::size_t wanted, double timeout) {
  std::vector<std::uint8_t> bytes;
  std::array<std::uint8_t, 64> packet{};
  const double start = link.now();
  while (bytes.size() < wanted && !link.lost()) {
    const double left = timeout - (link.now() - start);
    if (left <= 0) break;
    const std::size_t size = link.receive(packet, left);
    bytes.insert(bytes.end(), packet.begin(), packet.begin() + static_cast<std::ptrdiff_t>(size));
  }
  return bytes;
}

void enter_run_mode(FalconLink& link) {
  configure(link, {{latency, 1}, {baud, baud_1500k}, {ftdi_reset, ftdi_purge_received}, {ftdi_reset, purge_sent}});
}

bool answers_run_packets(Link& link) {
  FalconReplies replies;
  const auto command = encode(FalconCommand{});
  for (int attempt = 0; attempt < 10 && !link.lost(); ++attempt) {
    if (!send_now(link, command)) continue;
    if (!replies.feed(receive_bytes(link, falcon_packet_size, LockStepTimes().overdue))) continue;
    // Replies given up may only be late. Each would be taken for one to a command that is sent later.
    const auto is_on_its_way = [&] { return !receive_bytes(link, falcon_packet_size, LockStep::longest_way).empty(); };
    for (int given_up = attempt; given_up > 0 && is_on_its_way();) --given_up;
    return true;
  }
  return false;
}

bool greet(FalconLink& link) {
  constexpr std::array<std::uint8_t, 3> question{0x0a, 0x43, 0x0d};
  constexpr std::array<std::uint8_t, 4> answer{0x0a, 0x44, 0x2c, 0x0d};
  const double start = link.now();
  while (!link.lost() && link.now() - start < greeting_patience) {
    if (!send_now(link, question)) continue;
    // Some stacks put a zero byte in front.
    const auto bytes = receive_bytes(link, answer.size(), 0.050);
    if (std::search(bytes.begin(), bytes.end(), answer.begin(), answer.end()) != bytes.end()) return true;
  }
  return false;
}

/// One try; nothing, or what went wrong.
Text upload(FalconLink& link, const std::vector<std::uint8_t>& image) {
  configure(link, {{ftdi_reset, ftdi_purge_received},
                   {ftdi_reset, purge_sent},
                   {latency, 16},
                   {baud, baud_9600},
                   {framing, eight_n_one},
                   {flow_control, 0},
                   {modem, rts_low},
                   {modem, dtr_low},
                   {modem, dtr_high}});
  if (!greet(link)) return say("does-not-answer-the-greeting");
  configure(link, {{modem, dtr_low}, {baud, baud_140k}});
  constexpr std::array<std::uint8_t, 1> begin{'A'};
  if (!send_now(link, begin)) return say("does-not-take-the-start");
  const auto begun = receive_bytes(link, 1, 1.0);
  if (begun.empty() || begun.front() != 'A') return say("does-not-answer-the-start");
  for (std::size_t at = 0; at < image.size(); at += chunk) {
    const auto sent = std::span(image).subspan(at, std::min(chunk, image.size() - at));
    if (!send_now(link, sent)) return say("does-not-take-byte", at);
    // The echo is the only check there is.
    const auto echo = receive_bytes(link, sent.size(), 1.0);
    if (!std::equal(sent.begin(), sent.end(), echo.begin(), echo.end())) {
      return say("echo-differs-at-byte", at);
    }
  }
  return {};
}

std::vector<std::uint8_t> read_image(const std::string& file) {
  std::ifstream stream(file, std::ios::binary);
  std::vector<std::uint8_t> image{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  if (image.empty() || image.size() > largest_image) {
    throw Refusal(image.empty() ? say("novint-falcon-cannot-be-read", file) : say("novint-falcon-is-too-long", file));
  }
  return image;
}

}  // namespace

bool zero_falcon(FalconLink& link) noexcept {
  // The homing bit stays set: dropping it would make the Falcon forget where it is. A command cut short when the
  // session died takes the first of these to its end; the next ones are whole.
  const bool is_set =
      link.control(latency, 1) && link.control(baud, baud_1500k) && link.control(ftdi_reset, ftdi_purge_received);
  return is_set && answers_run_packets(link) && answers_run_packets(link);
}

void connect_falcon(FalconLink& link, const std::string& firmware_file) {
  configure(link, {{ftdi_reset, ftdi_purge_received}, {ftdi_reset, purge_sent}});
  enter_run_mode(link);
  if (answers_run_packets(link)) return;
  if (firmware_file.empty()) {
    throw Refusal(say("novint-falcon-it-has-no-firmware-since"));
  }
  const std::vector<std::uint8_t> image = read_image(firmware_file);
  Text trouble;
  const double start = link.now();
  for (int attempt = 0; attempt < 10 && !link.lost() && link.now() - start < upload_patience; ++attempt) {
    trouble = upload(link, image);
    // Whoever does not even greet is mute, and asking again would take the caller's time.
    if (trouble == say("does-not-answer-the-greeting")) break;
    if (!trouble.empty()) continue;
    enter_run_mode(link);
    if (answers_run_packets(link)) return;
    trouble = say("does-not-run-what-was-uploaded");
  }
  if (link.lost()) trouble = say("was-unplugged");
  throw Refusal(say("novint-falcon-the-firmware-could-not", firmware_file, trouble));
}

}  // namespace palpate::device
