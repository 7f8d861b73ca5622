#pragma once

/// The functions of libdrd.so that the driver uses, with its C types. C has no default arguments, so each call gives
/// the device's number.

#include <cstddef>
#include <string>

#include "device/link/shared_library.h"

namespace palpate::device {

/// More than DHD_MAX_STATUS, which grew from version to version (14, 15, 17, 20). The library writes that many entries.
constexpr std::size_t drd_status_size = 64;

struct DrdLibrary {
  /// Throws std::runtime_error as SharedLibrary does, and if the library is not of version 3.
  DrdLibrary();

  SharedLibrary library;
  void (*get_sdk_version)(int* major, int* minor, int* release, int* revision) = nullptr;
  int (*get_device_count)() = nullptr;
  int (*get_system_type)(char id) = nullptr;
  const char* (*get_system_name)(char id) = nullptr;
  int (*get_serial_number)(unsigned short* serial, char id) = nullptr;
  const char* (*error_get_last_str)() = nullptr;
  int (*open)(char id) = nullptr;
  int (*close)(char id) = nullptr;
  bool (*is_initialized)(char id) = nullptr;
  int (*auto_init)(char id) = nullptr;
  int (*stop)(bool keep_forces, char id) = nullptr;
  int (*enable_expert_mode)() = nullptr;
  int (*set_watchdog)(unsigned char duration, char id) = nullptr;
  int (*set_max_force)(double newtons, char id) = nullptr;
  double (*get_max_force)(char id) = nullptr;
  int (*set_gravity_compensation)(int on, char id) = nullptr;
  int (*enable_force)(unsigned char on, char id) = nullptr;
  int (*dhd_stop)(char id) = nullptr;
  int (*get_position)(double* x, double* y, double* z, char id) = nullptr;
  int (*get_orientation_frame)(double matrix[3][3], char id) = nullptr;
  bool (*has_wrist)(char id) = nullptr;
  unsigned (*get_button_mask)(char id) = nullptr;
  int (*get_status)(int* status, char id) = nullptr;
  int (*set_force_and_torque_and_gripper_force)(double fx, double fy, double fz, double tx, double ty, double tz,
                                                double gripper, char id) = nullptr;

  /// Empty if the device has no serial number: the library then gives 65535.
  std::string serial_of(char id) const;
  /// Lets the firmware take away a force that is not renewed for 30 ms. False if the device has no such watchdog.
  bool set_own_watchdog(char id) const noexcept;
};

}  // namespace palpate::device
