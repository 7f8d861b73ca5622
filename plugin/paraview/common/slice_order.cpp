#include "plugin/paraview/common/slice_order.h"

#include <cstddef>
#include <memory>
#include <tuple>

#include "io/dicom/series_source.h"

namespace palpate::plugin {

bool counted_from_last(const io::Series& series) {
  std::shared_ptr<const io::SeriesSource> source = series.source;
  if (source && !source->velocities.empty()) source = source->velocities.front()[0].source;
  if (!source || source->frames.empty()) return false;
  const auto& slices = source->frames.front().slices;
  const auto number = [&](const io::SeriesSource::Slice& slice) {
    return std::tuple(source->file_of(slice).instance_number, slice.plane);
  };
  int rises = 0;
  for (std::size_t k = 0; k + 1 < slices.size(); ++k) {
    if (number(slices[k]) < number(slices[k + 1])) ++rises;
    if (number(slices[k + 1]) < number(slices[k])) --rises;
  }
  return rises < 0;
}

}  // namespace palpate::plugin
