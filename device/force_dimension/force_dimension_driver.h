#pragma once

#include <memory>
#include <optional>
#include <string>

#include "device/force_dimension/drd_library.h"
#include "device/force_dimension/force_dimension.h"
#include "device/link/driver.h"
#include "device/link/driver_clock.h"
#include "device/link/link_stylus.h"
#include "device/setting_limits.h"

namespace palpate::device {

/// The force of an omega: 12 N. It can hold 14.5 N/mm, more than the program's ceiling allows.
constexpr SettingLimits force_dimension_limits{.force_n = 12, .tells_force = true};

/// A device that answers each call over USB: the stylus' own thread makes the calls.
class ForceDimensionDriver final : public Driver {
 public:
  explicit ForceDimensionDriver(const ForceDimensionSettings& settings, const DriverClock& clock = {})
      : settings_(settings), clock_(clock) {}

  void connect() override;
  void disconnect() noexcept override;
  double now() noexcept override;
  void take(double timeout) noexcept override;
  ForceAnswer give(const Vec3& force) noexcept override;
  void flush(double /*timeout*/) noexcept override {}
  bool lost() const noexcept override { return lost_; }
  const ProtocolStatus& status() const noexcept override { return status_; }
  void describe(Specification& specification) const override;

 private:
  void choose();
  void bring_up();
  void judge_status() noexcept;
  void fail(LinkFault fault) noexcept;
  std::string last_error() const;

  ForceDimensionSettings settings_;
  DriverClock clock_;
  std::unique_ptr<DrdLibrary> drd_;
  std::shared_ptr<void> no_search_;  // none opens the device while this is held
  char id_ = -1;
  bool has_wrist_ = false;
  double maximum_force_ = 0;
  std::string name_ = "Force Dimension";
  ProtocolStatus status_;
  bool has_watchdog_ = false;
  int pose_errors_ = 0;  // in a row
  int asked_ = 0;
  double next_ = 0;  // s: when the device is asked next
  bool lost_ = false;
};

/// The same stylus as make_force_dimension()'s, with other options.
std::unique_ptr<LinkStylus> make_force_dimension_with(const ForceDimensionSettings& settings,
                                                      const LinkStylusOptions& options, const DriverClock& clock = {});

/// Opens the device (without an address: each), switches its forces off and its brakes on, and closes it. Whether none
/// that is meant was left out. Throws std::runtime_error.
bool stop_force_dimension(const std::string& address);

}  // namespace palpate::device
