#pragma once

#include <semaphore.h>

#include <atomic>
#include <memory>
#include <string>

#include "device/link/driver.h"
#include "device/link/driver_clock.h"
#include "device/link/latest.h"
#include "device/link/link_stylus.h"
#include "device/setting_limits.h"
#include "device/touch/hd_library.h"
#include "device/touch/touch.h"

namespace palpate::device {

/// The limits of the strongest model ever sold as Touch X or Desktop, by its maker's data sheet: 7.9 N, 2.35 N/mm.
constexpr SettingLimits touch_limits{
    .force_n = 7.9, .stiffness_n_per_m = 2350, .tells_force = true, .tells_stiffness = true};

/// The library calls back a thousand times a second, in its own thread: poses and forces pass between the threads.
class TouchDriver final : public Driver {
 public:
  explicit TouchDriver(const TouchSettings& settings, const DriverClock& clock = {});
  ~TouchDriver() override;

  void connect() override;
  void disconnect() noexcept override;
  double now() noexcept override;
  void take(double timeout) noexcept override;
  ForceAnswer give(const Vec3& force) noexcept override {
    force_.store(force);
    return ForceAnswer::taken;
  }
  void flush(double timeout) noexcept override;
  bool lost() const noexcept override { return lost_; }
  const ProtocolStatus& status() const noexcept override { return status_; }
  void describe(Specification& specification) const override { specification = described_; }

 private:
  /// The data of one callback.
  struct Sample {
    Vec3 position_mm{0};
    double transform[16] = {};
    int buttons = 0;
    unsigned error = hd::success;
    unsigned calibration = hd::calibrated;
  };

  static unsigned on_schedule(void* self);
  Sample exchange() noexcept;
  void read_model();
  void drop_posts() noexcept;
  void follow(const Sample& sample) noexcept;
  void choose_calibration();
  void look_at_calibration(bool is_pushing) noexcept;
  void throw_error(const Text& what);

  TouchSettings settings_;
  DriverClock clock_;
  std::unique_ptr<HdLibrary> hd_;
  unsigned device_ = hd::invalid_device;
  unsigned long scheduled_ = 0;
  bool running_ = false;
  double maximum_force_ = 3.3;
  Specification described_;
  ProtocolStatus status_;
  bool lost_ = false;
  // Across the threads.
  Latest<Sample> sample_;
  Latest<Vec3> force_;
  sem_t sampled_;
  // The library's thread's.
  double called_ = 0;    // s: of the last callback
  int unrenewed_ = 0;    // callbacks since the last new force
  int calibrating_ = 0;  // callbacks since the calibration was last checked
  unsigned style_ = 0;   // of its calibration
  unsigned calibration_ = hd::needs_update;
  bool was_calibrated_ = false;
  bool pushed_ = false;  // in the last callback
};

/// The same stylus as make_touch()'s, with other options.
std::unique_ptr<LinkStylus> make_touch_with(const TouchSettings& settings, const LinkStylusOptions& options,
                                            const DriverClock& clock = {});

/// Opens the device in this process, sends zeros from the library's own thread, and closes it. Throws
/// std::runtime_error.
bool send_zeros_to_touch(const std::string& address);

}  // namespace palpate::device
