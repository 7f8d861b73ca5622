#pragma once

/// The functions of libHD.so that are used, with its C types and numbers.

#include <string>

#include "device/link/shared_library.h"

namespace palpate::device {

namespace hd {

struct ErrorInfo {  // 12 bytes, returned by value
  unsigned code;
  int internal;
  unsigned device;
};
using Callback = unsigned (*)(void*);

constexpr unsigned invalid_device = 0xffffffffU;
// What is read and written.
constexpr unsigned buttons = 0x2000, inkwell_switch = 0x2002, position = 0x2050, transform = 0x2052;
constexpr unsigned current_force = 0x2700, model_type = 0x2501, usable_workspace = 0x2551, calibration_style = 0x2555;
constexpr unsigned nominal_stiffness = 0x2602, nominal_force = 0x2603, nominal_continuous_force = 0x2604;
// What is switched on.
constexpr unsigned force_output = 0x4000, max_force_clamping = 0x4001, force_ramping = 0x4002;
// Calibration: what hdCheckCalibration() says, and the styles, of which a device has one or several.
constexpr unsigned calibrated = 0x5000, needs_update = 0x5001;
constexpr unsigned encoder_reset = 1, automatic = 2, inkwell = 4;
// Of a callback; of an error.
constexpr unsigned callback_continue = 1;
constexpr unsigned success = 0, warm_motors = 0x200, exceeded_force = 0x201, force_impulse = 0x202;

/// The severity of an error. Codes 0x2xx concern the force alone: the device still answers.
enum class Severity : unsigned char { none, force_clamped, force_taken_away, device_failed };
Severity severity_of(unsigned code) noexcept;

}  // namespace hd

struct HdLibrary {
  /// Throws std::runtime_error if the library or a function is missing (SharedLibrary).
  HdLibrary();

  SharedLibrary library;
  unsigned (*init_device)(const char* name) = nullptr;
  void (*disable_device)(unsigned device) = nullptr;
  void (*make_current_device)(unsigned device) = nullptr;
  void (*begin_frame)(unsigned device) = nullptr;
  void (*end_frame)(unsigned device) = nullptr;
  hd::ErrorInfo (*get_error)() = nullptr;
  const char* (*get_error_string)(unsigned code) = nullptr;
  void (*enable)(unsigned what) = nullptr;
  void (*get_doubles)(unsigned what, double* values) = nullptr;
  void (*get_integers)(unsigned what, int* values) = nullptr;
  const char* (*get_string)(unsigned what) = nullptr;
  void (*set_doubles)(unsigned what, const double* values) = nullptr;
  unsigned (*check_calibration)() = nullptr;
  void (*update_calibration)(unsigned style) = nullptr;
  void (*start_scheduler)() = nullptr;
  void (*stop_scheduler)() = nullptr;
  void (*set_scheduler_rate)(unsigned long hz) = nullptr;
  unsigned long (*schedule_asynchronous)(hd::Callback callback, void* data, unsigned short priority) = nullptr;
  void (*unschedule)(unsigned long handle) = nullptr;

  /// Empties the library's stack of errors, which keeps one for each call that failed. Returns the most serious one,
  /// and of several such the newest; hd::success if there is none.
  unsigned drain_errors() const noexcept;
  std::string words_for(unsigned code) const;
  /// Initializes the device of this name; empty: the default one. If that fails, returns hd::invalid_device, puts
  /// the code in `error`, and leaves nothing initialized. Warnings about the force (0x2xx) are no failure.
  unsigned open_device(const std::string& name, unsigned& error) const noexcept;
};

}  // namespace palpate::device
