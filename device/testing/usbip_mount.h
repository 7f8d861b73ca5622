#pragma once

/// A fake device on the kernel's virtual host controller, vhci_hcd: the real USB stack finds it, binds its drivers and
/// gives it to libusb. USB/IP frames go through a socket pair; the kernel gets one end.

#include <memory>

#include "device/testing/play.h"

namespace palpate::device {

class UsbipMount {
 public:
  /// Plugs the play's device into a full-speed port; the play outlives this. Throws std::system_error if there is no
  /// vhci_hcd or no permission for it. Unplugs it when the play requires it, and at the end.
  explicit UsbipMount(Play& play);
  ~UsbipMount();

  struct Parts;

 private:
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::device
