#include "plugin/session/tick_record.h"

#include <cstring>

namespace palpate::plugin {

bool same_in_replay(const TickRecord& a, const TickRecord& b) noexcept {
  return std::memcmp(&a, &b, offsetof(TickRecord, from_brick)) == 0;
}

}  // namespace palpate::plugin
