#include "plugin/paraview/common/value_range.h"

#include <vtkDataArray.h>
#include <vtkInformation.h>
#include <vtkInformationDoubleVectorKey.h>
#include <vtkInformationInformationVectorKey.h>
#include <vtkInformationVector.h>
#include <vtkNew.h>

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <span>
#include <type_traits>

namespace palpate::plugin {
namespace {

template <typename Stored>
struct Range {
  Stored low = std::numeric_limits<Stored>::max(), high = std::numeric_limits<Stored>::lowest();
  bool has_infinite = false;
};

/// The range of the finite values, without NaN and the lowest float, with which io marks missing data.
template <typename Stored>
Range<Stored> range_of(std::span<const Stored> values) {
  Range<Stored> range;
  for (const Stored value : values) {
    if constexpr (std::is_floating_point_v<Stored>) {
      range.has_infinite |= std::isinf(value);
      if (!std::isfinite(value) || value == std::numeric_limits<Stored>::lowest()) continue;
    }
    range.low = value < range.low ? value : range.low;
    range.high = value > range.high ? value : range.high;
  }
  return range;
}

void keep(vtkDataArray& array, vtkInformationInformationVectorKey& key, double low, double high) {
  vtkNew<vtkInformationVector> components;
  components->SetNumberOfInformationObjects(1);
  const std::array range{low, high};
  components->GetInformationObject(0)->Set(vtkDataArray::COMPONENT_RANGE(), range.data(), 2);
  array.GetInformation()->Set(&key, components);
}

template <typename Stored>
void keep_range_of(vtkDataArray& array) {
  const auto* const first = static_cast<const Stored*>(array.GetVoidPointer(0));
  const auto range = range_of(std::span(first, static_cast<std::size_t>(array.GetNumberOfValues())));
  if (range.low > range.high) return;
  keep(array, *vtkAbstractArray::PER_FINITE_COMPONENT(), range.low, range.high);
  if (!range.has_infinite) keep(array, *vtkAbstractArray::PER_COMPONENT(), range.low, range.high);
}

}  // namespace

void keep_range(vtkDataArray& array) {
  if (array.GetNumberOfComponents() != 1) return;
  switch (array.GetDataType()) {
    case VTK_SHORT:
      return keep_range_of<std::int16_t>(array);
    case VTK_UNSIGNED_SHORT:
      return keep_range_of<std::uint16_t>(array);
    case VTK_FLOAT:
      return keep_range_of<float>(array);
    default:
      return;
  }
}

}  // namespace palpate::plugin
