#include "io/dicom/slice_reader.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <type_traits>

#include "io/dicom/pixels.h"

namespace palpate::io::internal {
namespace {

// Stored values of 16 bits, or wide ones.
template <typename Stored>
void rescale(const FileHeader& file, const Reading::Rescale& by, std::span<const Stored> stored,
             std::span<float> values) {
  for (std::size_t i = 0; i < stored.size(); ++i) {
    double v = static_cast<double>(stored[i]);
    if constexpr (sizeof(Stored) == 2) v = file.format.is_signed ? static_cast<std::int16_t>(stored[i]) : stored[i];
    const bool padded = !std::isfinite(v) || (file.padding && v >= file.padding->first && v <= file.padding->second);
    const double value = file.table ? file.table->value_of(v) : by.slope * v + by.intercept;
    values[i] = padded ? float_padding : static_cast<float>(value);
  }
}

// Stored values of a slice -> its place in the volume, rescaled where the volume is of floats.
template <typename Stored>
void place_slice(const Reading& reading, const SeriesSource::Slice& slice, std::span<const Stored> frame,
                 std::size_t at, Volume::Voxels& voxels) {
  const FileHeader& file = reading.source.file_of(slice);
  const Plane& plane = reading.source.plane_of(slice);
  const auto columns = static_cast<std::size_t>(file.columns);
  for (std::size_t row = 0; row < static_cast<std::size_t>(file.rows); ++row) {
    const auto stored = frame.subspan(
        (plane.tile_row + row) * static_cast<std::size_t>(file.format.columns) + plane.tile_column, columns);
    std::visit(
        [&](auto& v) {
          const auto target = std::span(v).subspan(at + row * columns, columns);
          if constexpr (std::is_same_v<std::decay_t<decltype(v[0])>, float>) {
            rescale(file, reading.rescale_of(slice), stored, target);
          } else if constexpr (sizeof(Stored) == 2) {
            std::memcpy(target.data(), stored.data(), target.size_bytes());
          }
        },
        voxels);
  }
}

// Where a whole frame is one slice of 16-bit voxels, it is decoded in place.
std::span<std::uint16_t> in_place(const FileHeader& file, std::size_t at, Volume::Voxels& voxels) {
  if (file.columns != file.format.columns || file.rows != file.format.rows || file.format.is_wide()) return {};
  return std::visit(
      [&](auto& v) -> std::span<std::uint16_t> {
        if constexpr (sizeof(v[0]) != 2) return {};
        const std::size_t size = static_cast<std::size_t>(file.columns) * static_cast<std::size_t>(file.rows);
        return {reinterpret_cast<std::uint16_t*>(v.data() + at), size};  // signed and unsigned shorts may alias
      },
      voxels);
}

}  // namespace

Reading::Rescale Reading::rescale_of(const SeriesSource::Slice& slice) const {
  const Plane& plane = source.plane_of(slice);
  if (as_velocity) return {plane.velocity->slope, plane.velocity->intercept};
  return {plane.slope, plane.intercept};
}

std::vector<SliceUnit> slice_units(const Reading& reading) {
  constexpr std::size_t most = 16;
  const SeriesSource& source = reading.source;
  const Slices& slices = reading.frame.slices;
  std::vector<std::size_t> order(slices.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(slices[a].file, slices[a].plane) < std::tuple(slices[b].file, slices[b].plane);
  });
  std::vector<SliceUnit> units;
  for (const std::size_t k : order) {
    const bool same_file = !units.empty() && slices[units.back().front()].file == slices[k].file;
    const bool same_frame =
        same_file && source.plane_of(slices[units.back().back()]).frame == source.plane_of(slices[k]).frame;
    const bool one_go =
        same_file && source.file_of(slices[k]).coding == PixelCoding::deflated;  // inflated from its start
    if (!same_frame && !one_go && !(same_file && units.back().size() < most)) units.emplace_back();
    units.back().push_back(k);
  }
  return units;
}

void read_unit(const Reading& reading, const SliceUnit& unit, Volume::Voxels& voxels,
               const std::function<void(std::size_t, const char*)>& failed,
               const std::function<void(const Text&)>& noted) {
  const SeriesSource& source = reading.source;
  const Slices& slices = reading.frame.slices;
  const FileHeader& file = source.file_of(slices[unit.front()]);
  const std::size_t size = static_cast<std::size_t>(file.columns) * static_cast<std::size_t>(file.rows);
  std::optional<PixelReader> reader;
  std::vector<std::uint16_t> frame;
  std::vector<double> wide_frame;
  std::optional<std::uint32_t> held;
  const auto read = [&](std::uint32_t wanted, std::span<std::uint16_t> values) {
    const Text note = reader->read(wanted, values);
    if (!note.empty()) noted(note);
  };
  for (const std::size_t k : unit) {
    try {
      if (!reader) reader.emplace(file);
      const std::uint32_t wanted = source.plane_of(slices[k]).frame;
      if (const auto target = in_place(file, k * size, voxels); !target.empty()) {
        read(wanted, target);
        continue;
      }
      if (held != wanted) {
        held.reset();
        const std::size_t pixels =
            static_cast<std::size_t>(file.format.columns) * static_cast<std::size_t>(file.format.rows);
        if (file.format.is_wide()) {
          wide_frame.resize(pixels);
          reader->read_wide(wanted, wide_frame);
        } else {
          frame.resize(pixels);
          read(wanted, frame);
        }
        held = wanted;
      }
      if (file.format.is_wide()) {
        place_slice<double>(reading, slices[k], wide_frame, k * size, voxels);
      } else {
        place_slice<std::uint16_t>(reading, slices[k], frame, k * size, voxels);
      }
    } catch (const std::exception& error) {
      failed(k, error.what());
    }
  }
}

}  // namespace palpate::io::internal
