#include "io/structures/structured_fields.h"

#include <algorithm>
#include <cassert>
#include <utility>

namespace palpate::io {

StructuredFields::StructuredFields(std::shared_ptr<const FieldSource> scan,
                                   std::vector<std::shared_ptr<const DistanceField>> structures)
    : scan_(std::move(scan)), structures_(std::move(structures)) {
  assert(scan_ && structures_.size() <= most_structures);
  assert(std::find(structures_.begin(), structures_.end(), nullptr) == structures_.end());
}

Sample StructuredFields::sample(const Vec3& position_mm, FieldSet wanted) const noexcept {
  Sample sample = scan_->sample(position_mm, wanted);
  if (contains(wanted, FieldSet::distance)) {
    for (std::size_t n = 0; n < structures_.size(); ++n) {
      sample.distance[n] = structures_[n]->sample(position_mm);
    }
  }
  return sample;
}

}  // namespace palpate::io
