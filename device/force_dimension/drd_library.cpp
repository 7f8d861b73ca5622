#include "device/force_dimension/drd_library.h"

#include <array>
#include <cstdlib>
#include <stdexcept>
#include <string>
#include <vector>

#include "device/messages.h"

namespace palpate::device {

namespace {

constexpr const char* advice =
    "install Force Dimension's SDK 3.17 (forcedimension.com) and name its libdrd.so in PALPATE_LIBDRD, or set FDSDK to "
    "its folder";

std::vector<std::string> files() {
  std::vector<std::string> usual;
  const char* const sdk = std::getenv("FDSDK");
  if (sdk != nullptr) usual.push_back(std::string(sdk) + "/lib/release/lin-x86_64-gcc/libdrd.so");
  const char* const home = std::getenv("HOME");
  if (home != nullptr) usual.push_back(std::string(home) + "/.local/lib/libdrd.so");
  usual.insert(usual.end(), {"/usr/local/lib/libdrd.so", "libdrd.so.3", "libdrd.so"});
  return library_candidates("PALPATE_LIBDRD", usual);
}

}  // namespace

DrdLibrary::DrdLibrary() : library("Force Dimension", files(), advice) {
  library.find("dhdGetSDKVersion", get_sdk_version);
  library.find("dhdGetDeviceCount", get_device_count);
  library.find("dhdGetSystemType", get_system_type);
  library.find("dhdGetSystemName", get_system_name);
  library.find("dhdGetSerialNumber", get_serial_number);
  library.find("dhdErrorGetLastStr", error_get_last_str);
  library.find("drdOpenID", open);
  library.find("drdClose", close);
  library.find("drdIsInitialized", is_initialized);
  library.find("drdAutoInit", auto_init);
  library.find("drdStop", stop);
  library.find("dhdEnableExpertMode", enable_expert_mode);
  library.find("dhdSetWatchdog", set_watchdog);
  library.find("dhdSetMaxForce", set_max_force);
  library.find("dhdGetMaxForce", get_max_force);
  library.find("dhdSetGravityCompensation", set_gravity_compensation);
  library.find("dhdEnableForce", enable_force);
  library.find("dhdStop", dhd_stop);
  library.find("dhdGetPosition", get_position);
  library.find("dhdGetOrientationFrame", get_orientation_frame);
  library.find("dhdHasWrist", has_wrist);
  library.find("dhdGetButtonMask", get_button_mask);
  library.find("dhdGetStatus", get_status);
  library.find("dhdSetForceAndTorqueAndGripperForce", set_force_and_torque_and_gripper_force);
  int major = 0, minor = 0, release = 0, revision = 0;
  get_sdk_version(&major, &minor, &release, &revision);
  if (major != 3) {
    throw Refusal(say("force-dimension-is-version", library.file(), major, minor, advice));
  }
}

std::string DrdLibrary::serial_of(char id) const {
  constexpr unsigned short unknown = 65535;
  unsigned short serial = unknown;
  return get_serial_number(&serial, id) < 0 || serial == unknown ? std::string() : std::to_string(serial);
}

bool DrdLibrary::set_own_watchdog(char id) const noexcept {
  constexpr unsigned char duration = 240;  // x 125 us
  return enable_expert_mode() >= 0 && set_watchdog(duration, id) >= 0;
}

}  // namespace palpate::device
