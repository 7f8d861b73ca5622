#include "io/structures/structured_fields.h"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

namespace palpate::io {

StructuredFields::StructuredFields(std::shared_ptr<const FieldSource> scan,
                                   std::vector<std::shared_ptr<const DistanceField>> structures)
    : scan_(std::move(scan)), structures_(std::move(structures)) {
  if (!scan_ || std::find(structures_.begin(), structures_.end(), nullptr) != structures_.end()) {
    throw std::invalid_argument("no scan, or no structure");
  }
  if (structures_.size() > most_structures) {
    throw std::invalid_argument(std::to_string(structures_.size()) + " structures are too many; there may be " +
                                std::to_string(most_structures));
  }
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
