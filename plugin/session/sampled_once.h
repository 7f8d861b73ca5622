#pragma once

/// A source that keeps its last sample. A tick samples the place that the proxy has reached, for its record; the next
/// tick begins at that place. With this class both use one sample.

#include <memory>
#include <new>
#include <utility>

#include "io/fields/field_source.h"

namespace palpate::plugin {

/// The samples are equal to those of the source, to the last bit. To be used by one thread at a time.
class SampledOnce final : public io::FieldSource {
 public:
  explicit SampledOnce(std::shared_ptr<const io::FieldSource> source) : source_(std::move(source)) {}

  io::FieldSet available() const noexcept override { return source_->available(); }
  io::Sample sample(const io::Vec3& position_mm, io::FieldSet wanted) const noexcept override {
    if (!is_known_ || position_mm != place_mm_ || !contains(fields_, wanted)) {
      // Made in place: an assignment would copy the distances of all structures once more.
      new (&sample_) io::Sample(source_->sample(position_mm, wanted));
      place_mm_ = position_mm;
      fields_ = wanted;
      is_known_ = true;
    }
    return sample_;
  }
  const std::shared_ptr<const io::FieldSource>& source() const noexcept { return source_; }

 private:
  std::shared_ptr<const io::FieldSource> source_;
  mutable bool is_known_ = false;
  mutable io::Vec3 place_mm_{0};
  mutable io::FieldSet fields_ = io::FieldSet::none;
  mutable io::Sample sample_;
};

}  // namespace palpate::plugin
