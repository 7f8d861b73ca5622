#include "plugin/session/tick_ring.h"

namespace palpate::plugin {

void TickRing::push(const TickRecord& tick, std::span<const PrimitiveRecord> shares) noexcept {
  const std::uint64_t first = shares_.written();
  for (const PrimitiveRecord& share : shares) shares_.push(share);
  ticks_.push({tick, first});
}

bool TickRing::read(std::uint64_t n, TickRecord& tick, std::vector<PrimitiveRecord>* shares) const {
  Entry entry;
  if (!ticks_.read(n, entry)) return false;
  if (shares != nullptr) {
    const std::size_t before = shares->size();
    shares->resize(before + entry.tick.share_count);
    for (std::uint32_t i = 0; i < entry.tick.share_count; ++i) {
      if (!shares_.read(entry.first_share + i, (*shares)[before + i])) {
        shares->resize(before);
        return false;
      }
    }
  }
  tick = entry.tick;
  return true;
}

}  // namespace palpate::plugin
