#include "plugin/session/tick_record.h"

#include <cstring>

namespace palpate::plugin {

bool same_in_replay(const Frame& a, const Frame& b) noexcept {
  return std::memcmp(&a, &b, offsetof(Frame, from_brick)) == 0;
}

}  // namespace palpate::plugin
