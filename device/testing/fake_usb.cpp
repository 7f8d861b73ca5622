#include "device/testing/fake_usb.h"

#include <algorithm>

namespace palpate::device {

namespace {

// USB 2.0, tables 9-4, 9-5, 9-8 to 9-13; HID 1.11, sections 6.2.1 and 7.1.
constexpr std::uint8_t get_status = 0;
constexpr std::uint8_t clear_feature = 1;
constexpr std::uint8_t get_descriptor = 6;
constexpr std::uint8_t set_configuration = 9;
constexpr std::uint8_t set_interface = 11;
constexpr std::uint8_t device_type = 1;
constexpr std::uint8_t configuration_type = 2;
constexpr std::uint8_t string_type = 3;
constexpr std::uint8_t report_type = 0x22;
constexpr std::uint8_t bulk = 2;
constexpr std::uint8_t interrupt = 3;

std::uint8_t low(std::size_t word) {
  return static_cast<std::uint8_t>(word & 0xff);
}
std::uint8_t high(std::size_t word) {
  return static_cast<std::uint8_t>(word >> 8);
}

UsbBytes device_bytes(std::uint16_t vendor, std::uint16_t product, std::uint16_t release) {
  return {18, 1, 0, 2, 0, 0, 0, 64, low(vendor), high(vendor), low(product), high(product), low(release), high(release),
          1,  2, 3, 1};
}

UsbBytes joined(std::initializer_list<UsbBytes> parts) {
  UsbBytes bytes;
  for (const UsbBytes& part : parts) {
    for (const std::uint8_t byte : part) bytes.push_back(byte);
  }
  return bytes;
}

/// Endpoints of 64 bytes, interrupt ones asked every millisecond.
UsbBytes configuration_bytes(std::uint8_t interface_class, const UsbBytes& class_descriptor, std::uint8_t kind,
                             std::uint8_t in, std::uint8_t out) {
  const std::size_t total = 9 + 9 + class_descriptor.size() + 7 + 7;
  const std::uint8_t interval = kind == interrupt ? 1 : 0;
  return joined({{9, configuration_type, low(total), high(total), 1, 1, 0, 0x80, 45},
                 {9, 4, 0, 0, 2, interface_class, 0, 0, 2},
                 class_descriptor,
                 {7, 5, in, kind, 64, 0, interval},
                 {7, 5, out, kind, 64, 0, interval}});
}

/// UTF-16; number 0 is the list of languages.
UsbBytes string_descriptor(const FakeUsb& device, std::uint8_t number) {
  if (number == 0) return {4, string_type, 0x09, 0x04};
  const std::string text = number == 1 ? "fake" : (number == 2 ? device.name() : "1");
  UsbBytes bytes{static_cast<std::uint8_t>(2 + 2 * text.size()), string_type};
  for (const char letter : text) bytes = joined({bytes, {static_cast<std::uint8_t>(letter), 0}});
  return bytes;
}

class FalconOnUsb final : public FakeUsb {
 public:
  explicit FalconOnUsb(Play& play) : play_(play) {}

  UsbBytes device_descriptor() const override { return device_bytes(0x0403, 0xcb48, 0x0600); }
  UsbBytes configuration_descriptor() const override { return configuration_bytes(0xff, {}, bulk, 0x81, 0x02); }
  std::string name() const override { return "FALCON HAPTIC"; }

  std::optional<UsbBytes> control(const UsbSetup& setup, std::span<const std::uint8_t> /*data*/, double now) override {
    if (setup.type == 0x40) {
      play_.falcon->control(setup.request, setup.value, now);
      return UsbBytes{};
    }
    // What Linux's own driver for serial chips asks: its latency, its lines, its memory.
    if (setup.type == 0xc0) return UsbBytes(setup.length, 1);
    return std::nullopt;
  }
  void write(std::span<const std::uint8_t> packet, double now) override {
    play_.touch(now);
    play_.falcon->write(packet, now);
  }
  std::optional<std::size_t> read(std::span<std::uint8_t> packet, double now) override {
    return play_.falcon->read(packet, now);
  }

 private:
  Play& play_;
};

class HidOnUsb final : public FakeUsb {
 public:
  explicit HidOnUsb(Play& play) : play_(play), identity_(play.hid->identity()) {}

  UsbBytes device_descriptor() const override { return device_bytes(identity_.vendor, identity_.product, 0x0100); }
  UsbBytes configuration_descriptor() const override {
    const std::size_t size = identity_.report_descriptor.size();
    return configuration_bytes(3, {9, 0x21, 0x11, 1, 0, 1, report_type, low(size), high(size)}, interrupt, 0x81, 0x01);
  }
  std::string name() const override { return identity_.name; }

  std::optional<UsbBytes> control(const UsbSetup& setup, std::span<const std::uint8_t> /*data*/,
                                  double /*now*/) override {
    if (setup.type == 0x81 && setup.request == get_descriptor && high(setup.value) == report_type) {
      return identity_.report_descriptor;
    }
    constexpr std::uint8_t set_idle = 0x0a;
    if (setup.type == 0x21 && setup.request == set_idle) return UsbBytes{};
    return std::nullopt;
  }
  void write(std::span<const std::uint8_t> packet, double now) override { play_.hid->write(packet, now); }
  std::optional<std::size_t> read(std::span<std::uint8_t> packet, double now) override {
    play_.touch(now);
    return play_.hid->read(packet, now);
  }

 private:
  Play& play_;
  HidIdentity identity_;
};

}  // namespace

std::unique_ptr<FakeUsb> make_fake_usb(Play& play) {
  if (play.falcon) return std::make_unique<FalconOnUsb>(play);
  return std::make_unique<HidOnUsb>(play);
}

std::optional<UsbBytes> answer_control(FakeUsb& device, const UsbSetup& setup, std::span<const std::uint8_t> data,
                                       double now) {
  constexpr std::uint8_t standard_mask = 0x60;
  std::optional<UsbBytes> answer;
  if ((setup.type & standard_mask) == 0 && setup.request == get_descriptor && high(setup.value) == device_type) {
    answer = device.device_descriptor();
  } else if (setup.type == 0x80 && setup.request == get_descriptor && high(setup.value) == configuration_type) {
    answer = device.configuration_descriptor();
  } else if (setup.type == 0x80 && setup.request == get_descriptor && high(setup.value) == string_type) {
    answer = string_descriptor(device, low(setup.value));
  } else if ((setup.type & standard_mask) == 0 && setup.request == get_status) {
    answer = UsbBytes{0, 0};
  } else if ((setup.type & standard_mask) == 0 &&
             (setup.request == set_configuration || setup.request == set_interface || setup.request == clear_feature)) {
    answer = UsbBytes{};
  } else {
    answer = device.control(setup, data, now);
  }
  if (answer) answer->resize(std::min<std::size_t>(answer->size(), setup.length));
  return answer;
}

}  // namespace palpate::device
