/// The Falcon's bytes on a USB bus of the test's own, against what libusb says of its functions.

#include "device/falcon/falcon_usb.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <libusb.h>

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <random>
#include <string>
#include <vector>

#include "device/falcon/falcon_driver.h"
#include "device/falcon/falcon_protocol.h"
#include "device/testing/fake_libusb.h"

namespace palpate::device {
namespace {

using Bytes = std::vector<std::uint8_t>;

/// A packet as the serial chip sends it: its two status bytes first.
FakeUsbInput packet_with(const Bytes& payload) {
  Bytes bytes{0x01, 0x60};
  bytes.insert(bytes.end(), payload.begin(), payload.end());
  return {bytes, LIBUSB_TRANSFER_COMPLETED};
}

/// All that has come, asked for in parts of some size, without waiting.
Bytes received(FalconLink& link, std::size_t part = 64) {
  Bytes all, some(part);
  while (const std::size_t size = link.receive(some, 0)) {
    all.insert(all.end(), some.begin(), some.begin() + static_cast<std::ptrdiff_t>(size));
  }
  return all;
}

Bytes any_bytes(std::mt19937& random, std::size_t size) {
  Bytes bytes(size);
  for (std::uint8_t& byte : bytes) byte = static_cast<std::uint8_t>(random());
  return bytes;
}

/// Lets events be handled once, and nothing more.
void handle(FalconLink& link) {
  std::array<std::uint8_t, 1> none{};
  link.receive(std::span(none).first(0), 0);
}

std::string refusal(const std::function<void()>& open) {
  try {
    open();
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(FalconUsb, ReceivesEveryByteInItsOrderHoweverItIsSplit) {
  std::mt19937 random(1);
  FakeUsb usb;
  const auto link = open_falcon_usb("");
  EXPECT_EQ(usb.most_read, 64) << "what one packet of the chip holds";
  for (int round = 0; round < 200; ++round) {
    Bytes sent;
    for (std::size_t packets = random() % 5; packets > 0; --packets) {
      const Bytes payload = any_bytes(random, random() % 63);
      sent.insert(sent.end(), payload.begin(), payload.end());
      usb.input.push_back(packet_with(payload));
    }
    if (round % 7 == 0) usb.input.push_back({{0x01}, LIBUSB_TRANSFER_COMPLETED});
    ASSERT_EQ(received(*link, 1 + random() % 64), sent) << round;
  }
  EXPECT_FALSE(link->lost());
}

/// The chip puts two bytes of status in front of whatever it sends, of nothing, too.
TEST(FalconUsb, TheStatusOfTheChipIsNoData) {
  std::mt19937 random(3);
  for (std::size_t size = 0; size <= 64; ++size) {
    const Bytes raw = any_bytes(random, size);
    for (const std::size_t room : {0U, 1U, 16U, 62U, 64U}) {
      Bytes packet(room), wanted(room);
      const std::size_t carried = size > 2 ? std::min(size - 2, room) : 0;
      for (std::size_t n = 0; n < carried; ++n) wanted[n] = raw[n + 2];
      EXPECT_EQ(falcon_payload(raw, packet), carried);
      EXPECT_EQ(packet, wanted) << size << " " << room;
    }
  }
}

/// 4096 bytes wait for whoever asks; with one more all that waited goes, and the newest stays.
TEST(FalconUsb, WhereNobodyReadsTheNewestStays) {
  for (const std::size_t last : {4U, 5U, 62U}) {
    std::mt19937 random(2);
    FakeUsb usb;
    const auto link = open_falcon_usb("");
    Bytes all;
    for (int n = 0; n < 67; ++n) {
      const Bytes payload = any_bytes(random, n < 66 ? 62 : last);
      all.insert(all.end(), payload.begin(), payload.end());
      usb.input.push_back(packet_with(payload));
    }
    handle(*link);
    ASSERT_TRUE(usb.input.empty());
    const std::size_t kept = all.size() <= 4096 ? all.size() : last;
    EXPECT_EQ(received(*link), Bytes(all.end() - static_cast<std::ptrdiff_t>(kept), all.end())) << last;
    usb.input.push_back(packet_with({7, 8, 9}));
    EXPECT_EQ(received(*link), (Bytes{7, 8, 9}));
  }
}

/// It waits for a packet as long as it was told to, and not at all for one that is there.
TEST(FalconUsb, WaitsAsLongAsItIsTold) {
  FakeUsb usb;
  const auto link = open_falcon_usb("");
  Bytes packet(64);
  for (const double timeout_s : {0.0, 0.25, 1.5, 2.75}) {
    usb.input.push_back(packet_with({1, 2, 3}));
    usb.waits.clear();
    EXPECT_EQ(link->receive(packet, timeout_s), 3U);
    ASSERT_EQ(usb.waits.size(), 1U);
    EXPECT_NEAR(usb.waits[0], timeout_s, 2e-6);
  }
  usb.input.push_back(packet_with(Bytes(40)));
  link->receive(std::span(packet).first(10), 0);
  usb.waits.clear();
  EXPECT_EQ(link->receive(packet, 1), 30U);
  EXPECT_TRUE(usb.waits.empty()) << "some had been left";
  // Nothing comes: each wait is for what is left of the time, and a negative one for nothing.
  const double begun = link->now();
  EXPECT_EQ(link->receive(packet, 0.01), 0U);
  EXPECT_GE(link->now() - begun, 0.01);
  EXPECT_GT(usb.waits.size(), 1U);
  EXPECT_TRUE(std::is_sorted(usb.waits.rbegin(), usb.waits.rend()));
  usb.waits.clear();
  EXPECT_EQ(link->receive(packet, -1), 0U);
  EXPECT_EQ(usb.waits, std::vector<double>{0});
}

/// A transfer that fails may be a stall; twenty in a row, of whichever kind, are a device that is gone.
TEST(FalconUsb, IsLostAfterTwentyErrorsInARow) {
  for (const int status : {LIBUSB_TRANSFER_ERROR, LIBUSB_TRANSFER_TIMED_OUT, LIBUSB_TRANSFER_STALL}) {
    FakeUsb usb;
    const auto link = open_falcon_usb("");
    for (int round = 0; round < 3; ++round) {
      for (int n = 0; n < 19; ++n) usb.input.push_back({{0x01, 0x60, 1}, status});
      usb.input.push_back(packet_with({9}));
      EXPECT_EQ(received(*link), Bytes{9}) << "what came with an error is nothing";
      EXPECT_FALSE(link->lost());
    }
    for (int n = 0; n < 10; ++n) {
      usb.output.push_back(status);
      EXPECT_TRUE(link->send(Bytes(16)));
      EXPECT_TRUE(link->flush(1));
      usb.input.push_back({{}, status});
      EXPECT_FALSE(link->lost()) << n;
      handle(*link);
    }
    EXPECT_TRUE(link->lost());
    EXPECT_FALSE(link->send(Bytes(16)));
    EXPECT_FALSE(link->flush(1));
    usb.input.push_back(packet_with({1}));
    EXPECT_EQ(received(*link), Bytes{}) << "nothing is asked of it any more";
  }
}

/// What says at once that nobody is there is believed, and ends the waiting.
TEST(FalconUsb, IsLostAtOnceWhereItsDeviceIsGone) {
  const std::function<void(FakeUsb&, FalconLink&)> causes[] = {[](FakeUsb& usb, FalconLink&) {
                                                                 usb.input.push_back({{}, LIBUSB_TRANSFER_NO_DEVICE});
                                                               },
                                                               [](FakeUsb& usb, FalconLink& link) {
                                                                 usb.output.push_back(LIBUSB_TRANSFER_NO_DEVICE);
                                                                 link.send(Bytes(16));
                                                               },
                                                               [](FakeUsb& usb, FalconLink& link) {
                                                                 usb.submit_fails = LIBUSB_ERROR_NO_DEVICE;
                                                                 EXPECT_FALSE(link.send(Bytes(16)));
                                                               },
                                                               [](FakeUsb& usb, FalconLink&) {
                                                                 usb.submit_fails = LIBUSB_ERROR_IO;
                                                                 usb.input.push_back(packet_with({}));
                                                               },
                                                               [](FakeUsb& usb, FalconLink& link) {
                                                                 usb.control_result = LIBUSB_ERROR_NO_DEVICE;
                                                                 EXPECT_FALSE(link.control(0, 0));
                                                               }};
  for (const auto& cause : causes) {
    FakeUsb usb;
    auto link = open_falcon_usb("");
    EXPECT_FALSE(link->lost());
    cause(usb, *link);
    Bytes packet(64);
    const double begun = link->now();
    EXPECT_EQ(link->receive(packet, 60), 0U);
    EXPECT_LT(link->now() - begun, 30);
    EXPECT_TRUE(link->lost());
    link.reset();
    EXPECT_TRUE(usb.holds_nothing());
  }
}

/// One command at a time, as it was when it was given; the next is taken when it has left.
TEST(FalconUsb, SendsOneCommandAfterTheOther) {
  std::mt19937 random(3);
  FakeUsb usb;
  const auto link = open_falcon_usb("");
  EXPECT_TRUE(link->flush(0)) << "nothing was sent";
  std::vector<Bytes> sent;
  for (const std::size_t size : {1U, 16U, 63U, 64U}) {
    usb.takes = false;
    Bytes command = any_bytes(random, size);
    sent.push_back(command);
    EXPECT_TRUE(link->send(command)) << size;
    command.assign(size, 0);
    EXPECT_FALSE(link->send(command)) << "the one before is under way";
    EXPECT_FALSE(link->flush(1e-3));
    usb.takes = true;
    EXPECT_TRUE(link->flush(1));
  }
  EXPECT_EQ(usb.written, sent);
  EXPECT_FALSE(link->send(Bytes(65))) << "longer than a packet";
  EXPECT_FALSE(link->lost());
  usb.takes = false;
  EXPECT_TRUE(link->send(Bytes{1}));
  usb.takes = true;
  EXPECT_TRUE(link->send(Bytes{2})) << "it has left meanwhile";
  EXPECT_TRUE(link->flush(1));
  EXPECT_EQ(usb.written.size(), 6U);
  for (const unsigned timeout : usb.timeouts_ms) EXPECT_EQ(timeout, 1000U);
}

/// Vendor requests to the device without data. That which empties the chip's receive buffer empties ours.
TEST(FalconUsb, AsksTheSerialChip) {
  FakeUsb usb;
  const auto link = open_falcon_usb("");
  for (const auto& [request, value] : {std::pair{9, 1}, {0, 2}, {1, 1}, {3, 0x4138}, {0, 1}, {2, 0}}) {
    usb.input.push_back(packet_with({1, 2, 3}));
    handle(*link);
    EXPECT_TRUE(link->control(static_cast<std::uint8_t>(request), static_cast<std::uint16_t>(value)));
    const bool purges = request == ftdi_reset && value == ftdi_purge_received;
    EXPECT_EQ(received(*link).size(), purges ? 0U : 3U) << request << " " << value;
    EXPECT_EQ(usb.requests.back(), (FakeUsbRequest{0x40, request, value, 0, 0, 1000}));
  }
  usb.control_result = LIBUSB_ERROR_PIPE;
  EXPECT_FALSE(link->control(9, 1));
  EXPECT_FALSE(link->lost()) << "it refuses, but it is there";
  usb.control_result = 1;
  EXPECT_TRUE(link->control(9, 1));
}

/// Whatever is under way, and however long it takes to come back, nothing is left when the link is closed.
TEST(FalconUsb, LeavesNothingBehind) {
  for (const bool sending : {false, true}) {
    for (const int slow : {0, 1, 5}) {
      FakeUsb usb;
      auto link = open_falcon_usb("");
      EXPECT_TRUE(usb.detaches) << "the kernel takes it for a serial port";
      EXPECT_EQ(usb.claims, 1);
      EXPECT_EQ(usb.transfers, 2);
      usb.takes = false;
      if (sending) link->send(Bytes(16));
      usb.slow_cancels = slow;
      usb.waits.clear();
      link.reset();
      EXPECT_TRUE(usb.holds_nothing()) << sending << slow;
      EXPECT_LE(usb.waits.size(), static_cast<std::size_t>(slow) + 1);
      for (const double wait : usb.waits) EXPECT_NEAR(wait, 0.01, 1e-5);
    }
  }
}

/// The library still writes to one that has not ended: after a second the link is closed, and that one is left to it.
TEST(FalconUsb, ATransferThatNeverEndsIsNotFreed) {
  for (const bool sending : {false, true}) {
    FakeUsb usb;
    auto link = open_falcon_usb("");
    usb.takes = false;
    if (sending) link->send(Bytes(16));
    usb.slow_cancels = 1'000'000'000;
    const double begin = monotonic_time();
    link.reset();
    EXPECT_GE(monotonic_time() - begin, 1);
    EXPECT_LT(monotonic_time() - begin, 5);
    EXPECT_EQ(usb.transfers, sending ? 2 : 1);
    EXPECT_EQ(usb.misuses, 0);
    EXPECT_EQ(usb.claims + usb.handles + usb.contexts, 0);
  }
}

TEST(FalconUsb, OneThatCannotBeOpenedIsSaidAndLeavesNothing) {
  const struct {
    std::function<void(FakeUsb&)> what;
    const char* said;
  } cases[] = {
      {[](FakeUsb& usb) { usb.init_fails = LIBUSB_ERROR_NO_MEM; }, "USB cannot be used here: "},
      {[](FakeUsb& usb) { usb.list_fails = LIBUSB_ERROR_NO_MEM; }, "Novint Falcon: not found"},
      {[](FakeUsb& usb) { usb.devices.clear(); }, "Novint Falcon: not found"},
      {[](FakeUsb& usb) { usb.devices[0].descriptor_fails = LIBUSB_ERROR_IO; }, "Novint Falcon: not found"},
      {[](FakeUsb& usb) { ++usb.devices[0].vendor; }, "Novint Falcon: not found"},
      {[](FakeUsb& usb) { ++usb.devices[0].product; }, "Novint Falcon: not found"},
      {[](FakeUsb& usb) { usb.devices.resize(2); }, "Novint Falcon: there are 2; name the address"},
      {[](FakeUsb& usb) { usb.devices[0].open_fails = LIBUSB_ERROR_ACCESS; }, "Novint Falcon: permission denied; type"},
      {[](FakeUsb& usb) { usb.devices[0].open_fails = LIBUSB_ERROR_IO; }, "Novint Falcon: cannot be opened: "},
      {[](FakeUsb& usb) { usb.devices[0].claim_fails = LIBUSB_ERROR_BUSY; },
       "another program holds it (Resource busy)"},
  };
  for (const auto& one : cases) {
    FakeUsb usb;
    one.what(usb);
    EXPECT_THAT(refusal([] { open_falcon_usb(""); }), ::testing::HasSubstr(one.said));
    EXPECT_TRUE(usb.holds_nothing()) << one.said;
  }
}

/// By its socket, or by the kernel's number; and the only one by nothing.
TEST(FalconUsb, IsOpenedAtItsAddress) {
  FakeUsb usb;
  usb.devices = {{.bus = 1, .number = 2, .ports = {3}},
                 {.bus = 1, .number = 12, .ports = {3, 1, 4}},
                 {.bus = 2, .number = 2, .ports = {}},
                 {.product = 0x6001, .bus = 3, .number = 1, .ports = {3}}};
  const struct {
    const char* address;
    int device;
  } addresses[] = {{"1-3", 0}, {"001:002", 0}, {"1-3.1.4", 1}, {"001:012", 1}, {"002:002", 2}};
  for (const auto& one : addresses) {
    open_falcon_usb(one.address);
    EXPECT_EQ(usb.opened, one.device) << one.address;
  }
  for (const char* const none : {"1-3.1", "3-3", "003:001", "2", "1-4"}) {
    EXPECT_THAT(refusal([&] { open_falcon_usb(none); }),
                ::testing::HasSubstr(std::string("Novint Falcon at ") + none + ": not found"));
  }
  EXPECT_THAT(refusal([] { open_falcon_usb(""); }), ::testing::HasSubstr("there are 3"));
  EXPECT_TRUE(usb.holds_nothing());
}

TEST(FalconUsb, ListsEachWithItsAddressAndWhetherItMayBeOpened) {
  FakeUsb usb;
  usb.devices = {{.ports = {3}},
                 {.vendor = 0x0404, .ports = {4}},
                 {.ports = {5}, .open_fails = LIBUSB_ERROR_ACCESS},
                 {.bus = 4, .number = 17, .ports = {}, .open_fails = LIBUSB_ERROR_IO}};
  const auto found = find_falcons();
  ASSERT_EQ(found.size(), 3U);
  const char* const addresses[] = {"1-3", "1-5", "004:017"};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(found[i].kind, "falcon");
    EXPECT_EQ(found[i].name, "Novint Falcon");
    EXPECT_EQ(found[i].address, addresses[i]);
    EXPECT_EQ(found[i].accessible, i == 0);
  }
  EXPECT_EQ(found[0].note, "");
  EXPECT_EQ(found[1].note, permission_advice());
  EXPECT_EQ(found[2].note, "Input/Output Error");
  EXPECT_TRUE(usb.holds_nothing());
  usb.init_fails = LIBUSB_ERROR_OTHER;
  EXPECT_TRUE(find_falcons().empty());
}

/// Where there is no USB, no Falcon of that address, or no node of it, nothing is sent and nothing is left.
TEST(FalconUsb, OneThatIsNotThereIsNotTakenFromAnybody) {
  FakeUsb usb;
  usb.devices = {{.bus = 250, .number = 251}};  // such a bus has no node
  for (const char* const address : {"", "1-3", "250-3", "250:251"}) {
    EXPECT_FALSE(take_falcon_and_send_zeros(address)) << address;
    EXPECT_TRUE(usb.holds_nothing());
  }
  usb.init_fails = LIBUSB_ERROR_OTHER;
  EXPECT_FALSE(take_falcon_and_send_zeros(""));
  EXPECT_EQ(usb.misuses, 0);
  EXPECT_TRUE(usb.written.empty());
}

}  // namespace
}  // namespace palpate::device
