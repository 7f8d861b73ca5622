#pragma once

/// A scan's fields and the distances from structures at the same point.

#include <memory>
#include <vector>

#include "io/fields/field_source.h"
#include "io/structures/distance_field.h"

namespace palpate::io {

class StructuredFields final : public FieldSource {
 public:
  /// At most most_structures structures, none of them null.
  StructuredFields(std::shared_ptr<const FieldSource> scan,
                   std::vector<std::shared_ptr<const DistanceField>> structures);

  FieldSet available() const noexcept override { return scan_->available() | FieldSet::distance; }
  Sample sample(const Vec3& position_mm, FieldSet wanted) const noexcept override;

  const std::shared_ptr<const FieldSource>& scan() const noexcept { return scan_; }
  const std::vector<std::shared_ptr<const DistanceField>>& structures() const noexcept { return structures_; }

 private:
  std::shared_ptr<const FieldSource> scan_;
  std::vector<std::shared_ptr<const DistanceField>> structures_;
};

}  // namespace palpate::io
