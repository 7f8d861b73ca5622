#pragma once

/// The fake Falcon behind usbdevfs, as libusb finds it.

#include <umockdev.h>

#include <memory>

#include "palpate/device/internal/fakes/fake_falcon.h"

namespace palpate::device {

class UmockdevFalcon {
 public:
  /// Unplugged `unplug_after` s after the first packet.
  UmockdevFalcon(const FakeFalconOptions& options, double unplug_after);
  ~UmockdevFalcon();

  void attach(UMockdevTestbed* testbed, GError** error);
  // From any thread.
  bool is_pushing() const;
  unsigned long long commands() const;

  struct Parts;

 private:
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::device
