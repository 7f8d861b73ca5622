#include "device/device_type.h"

#include <array>

namespace palpate::device {

// The list of kinds comes from device/CMakeLists.txt: DEVICE(simulated) DEVICE(falcon) ...
#define DEVICE(kind) extern const DeviceType kind##_type;
PALPATE_DEVICES
#undef DEVICE

std::span<const DeviceType* const> device_types() {
#define DEVICE(kind) &kind##_type,
  static const std::array types{PALPATE_DEVICES};
#undef DEVICE
  return types;
}

const DeviceType* find_device_type(std::string_view kind) {
  for (const DeviceType* type : device_types()) {
    if (type->kind == kind) return type;
  }
  return nullptr;
}

std::string device_kinds() {
  std::string kinds;
  for (const DeviceType* type : device_types()) kinds += (kinds.empty() ? "" : ", ") + std::string(type->kind);
  return kinds;
}

}  // namespace palpate::device
