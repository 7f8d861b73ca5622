#pragma once

/// A SpaceMouse as seen through its reports: motion every 8 ms while it is deflected, one report of zeros at the end,
/// then silence.

#include <cstdint>

#include "device/stylus.h"
#include "device/testing/fake_hid.h"

namespace palpate::device {

class FakeSpaceMouse final : public FakeHid {
 public:
  /// `together`: translation and rotation are in one report, as in newer pucks.
  explicit FakeSpaceMouse(bool together) : together_(together) {}

  /// Raw counts along the puck's own axes (x right, y towards the user, z down), about -350 to 350.
  void deflect(const Vec3& counts) { deflection_ = counts; }
  void press(std::uint32_t buttons) { buttons_ = buttons; }

  HidIdentity identity() const override;
  std::optional<std::size_t> read(std::span<std::uint8_t> report, double now) override;
  void write(std::span<const std::uint8_t> /*report*/, double /*now*/) override {}
  bool is_pushing(double /*now*/) const override { return false; }

  bool loses_zero = false;  ///< the report of its release never arrives

  std::uint64_t reports() const noexcept { return report_count_; }

 private:
  bool together_;
  Vec3 deflection_{0};
  Vec3 reported_{0};
  std::uint32_t buttons_ = 0;
  std::uint32_t reported_buttons_ = 0;
  double next_ = 0;
  std::uint64_t report_count_ = 0;
};

}  // namespace palpate::device
