#pragma once

/// A fake HID device behind hidraw, as hidapi finds it.

#include <umockdev.h>

#include <memory>
#include <string>

#include "palpate/device/internal/fakes/fake_hid.h"

namespace palpate::device {

struct UmockdevHidIdentity {
  std::string vendor, product;  ///< four hexadecimal digits
  std::string name;
  std::string report_descriptor;  ///< hexadecimal
};

class UmockdevHid {
 public:
  /// Plays `device`, which outlives this, as /dev/hidraw0. Unplugged `unplug_after` s after the first output report.
  UmockdevHid(FakeHid& device, const UmockdevHidIdentity& identity, double unplug_after);
  ~UmockdevHid();

  void attach(UMockdevTestbed* testbed, GError** error);
  // From any thread.
  bool is_pushing() const;
  unsigned long long reports() const;

  struct Parts;

 private:
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::device
