#pragma once

/// The description of a kind of stylus: one object for each kind (<kind>/<kind>_type.cpp). device/CMakeLists.txt lists
/// the kinds. The command line, the plan, the guardian and the panel read the list.

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "device/found_devices.h"
#include "device/safety/guardian_beat.h"
#include "device/stylus.h"

namespace palpate::device {

/// How a user chooses a stylus of a kind.
struct DeviceChoice {
  std::string address;   ///< which device, if several are plugged in: FoundDevice::address
  std::string firmware;  ///< a file, for kinds that need it
  std::string settings;  ///< a JSON file; its keys are the names in the kind's settings
  std::uint64_t seed = 1;
  double rate_hz = 1000;  ///< of the simulated stylus
};

/// The file that a kind needs from the user.
enum class DeviceFile : std::uint8_t { none, firmware, settings };

/// The guardian's means to stop a device, and their speed.
struct GuardianMeans {
  GuardianReach reach = GuardianReach::none;
  double zero_within_s = 0;  ///< s from its first action until the device has taken a zero
};

struct DeviceType {
  std::string_view kind;      ///< as in --device
  std::string_view name;      ///< the maker's name for it
  std::string_view can;       ///< the axes that it senses and those with force
  std::string_view needs;     ///< what it needs before it can be opened; empty: nothing
  std::string_view homing;    ///< what the user does while its state is State::homing; empty: nothing
  std::string_view sold;      ///< whether it can be bought
  std::string_view tested;    ///< how it was tested
  std::string_view watchdog;  ///< what takes the force away if the program cannot reach it any more
  DeviceFile file = DeviceFile::none;
  std::string_view file_hint;  ///< what that file contains
  bool has_force = true;
  bool is_simulated = false;                     ///< no hardware; it runs as fast as the program calls it
  std::vector<FoundDevice> (*find)() = nullptr;  ///< never throws; null: it is always present
  /// Makes a closed stylus. Throws std::runtime_error naming the device, the flaw in its settings and what to do.
  std::shared_ptr<Stylus> (*make)(const DeviceChoice& choice) = nullptr;
  /// For the guardian: opens the device again and sends zeros. `take_away`: takes it from a process that is stopped.
  /// Null: the kind has no motors.
  bool (*send_zeros)(const std::string& address, bool take_away) = nullptr;
  /// For the guardian, when it starts: loads what send_zeros() needs and remembers which device it is. Never throws.
  GuardianMeans (*prepare_zeros)(const std::string& address) = nullptr;
};

/// How every driver of real hardware was tested.
constexpr std::string_view protocol_tested = "protocol-tested, never run on hardware";

/// All kinds, the simulated one first.
std::span<const DeviceType* const> device_types();
/// Null if no kind has that name.
const DeviceType* find_device_type(std::string_view kind);
/// "simulated, falcon, ...": for messages.
std::string device_kinds();

}  // namespace palpate::device
