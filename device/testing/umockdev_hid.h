#pragma once

/// A fake HID device behind hidraw, for hidapi.

#include <umockdev.h>

#include <memory>

#include "device/testing/play.h"

namespace palpate::device {

class UmockdevHid {
 public:
  /// The play has a HID device and outlives this. Its node is /dev/hidraw0.
  explicit UmockdevHid(Play& play);
  ~UmockdevHid();

  void attach(UMockdevTestbed* testbed, GError** error);

  struct Parts;

 private:
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::device
