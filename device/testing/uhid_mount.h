#pragma once

/// A fake HID device through the kernel's uhid: the real HID stack finds it and gives it to hidapi as a hidraw node.

#include <memory>

#include "device/testing/play.h"

namespace palpate::device {

class UhidMount {
 public:
  /// Plugs the play's HID device in; the play outlives this. Throws std::system_error if there is no /dev/uhid or no
  /// permission for it. Unplugs it when the play requires it, and at the end.
  explicit UhidMount(Play& play);
  ~UhidMount();

  struct Parts;

 private:
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::device
