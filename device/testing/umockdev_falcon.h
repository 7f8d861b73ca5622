#pragma once

/// The fake Falcon behind usbdevfs, for libusb.

#include <umockdev.h>

#include <memory>

#include "device/testing/play.h"

namespace palpate::device {

class UmockdevFalcon {
 public:
  /// The play has a Falcon and outlives this.
  explicit UmockdevFalcon(Play& play);
  ~UmockdevFalcon();

  void attach(UMockdevTestbed* testbed, GError** error);

  struct Parts;

 private:
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::device
