#include "modes/types/mode_type.h"

#include <array>

namespace palpate::modes {

// The list of modes comes from modes/CMakeLists.txt: MODE(force) MODE(follow) ...
#define MODE(name) extern const ModeType name##_mode;
PALPATE_MODES
#undef MODE

std::span<const ModeType* const> mode_types() {
#define MODE(name) &name##_mode,
  static const std::array types{PALPATE_MODES};
#undef MODE
  return types;
}

const ModeType* find_mode_type(std::string_view name) {
  for (const ModeType* type : mode_types()) {
    if (type->name == name) {
      return type;
    }
  }
  return nullptr;
}

bool reads_key(const Mode& mode, Key key) {
  const ModeType* const type = find_mode_type(mode.type);
  return type != nullptr && contains(type->keys, key);
}

std::string mode_type_names() {
  std::string names;
  for (const ModeType* type : mode_types()) {
    names += (names.empty() ? "" : ", ") + std::string(type->name);
  }
  return names;
}

}  // namespace palpate::modes
