#include "palpate/io/load.h"

#include <algorithm>
#include <cstring>
#include <functional>
#include <limits>
#include <mutex>
#include <numeric>
#include <optional>
#include <span>
#include <tuple>
#include <type_traits>

#include "palpate/io/errors.h"
#include "palpate/io/internal/pages.h"
#include "palpate/io/internal/parallel.h"
#include "palpate/io/internal/pixels.h"
#include "palpate/io/internal/series_source.h"
#include "palpate/io/internal/stacking.h"
#include "palpate/io/internal/velocity.h"

namespace palpate::io {
namespace {

using Slices = std::vector<SeriesSource::Slice>;

/// What is to be read: the rescaled values of a frame, or the velocities (m/s) that they stand for.
struct Reading {
  const SeriesSource& source;
  const SeriesSource::Frame& frame;
  bool as_velocity = false;

  struct Rescale {
    double slope = 1;
    double intercept = 0;
    bool operator==(const Rescale&) const = default;
  };
  Rescale rescale_of(const SeriesSource::Slice& slice) const {
    const internal::Plane& plane = source.plane_of(slice);
    if (as_velocity) return {plane.velocity->slope, plane.velocity->intercept};
    return {plane.slope, plane.intercept};
  }
};

std::string name_of(const Series& series) {
  return "series " + series.uid + (series.description.empty() ? "" : " (" + series.description + ")");
}

bool one_rescale(const Reading& reading) {
  const Slices& slices = reading.frame.slices;
  return std::all_of(slices.begin(), slices.end(), [&](const SeriesSource::Slice& slice) {
    return reading.rescale_of(slice) == reading.rescale_of(slices.front()) &&
           reading.source.file_of(slice).padding == reading.source.file_of(slices.front()).padding;
  });
}

enum class Storage { as_signed, as_unsigned, as_float };

Storage storage_for(const Reading& reading) {
  if (!one_rescale(reading)) return Storage::as_float;
  bool any_signed = false;
  bool any_large = false;
  for (const auto& slice : reading.frame.slices) {
    const internal::PixelFormat& format = reading.source.file_of(slice).format;
    any_signed |= format.is_signed;
    any_large |= !format.is_signed && format.bits_stored == 16;
  }
  if (!any_signed) return Storage::as_unsigned;
  return any_large ? Storage::as_float : Storage::as_signed;
}

template <typename Stored>
std::vector<Stored> allocated(std::size_t count, int threads) {
  std::vector<Stored> voxels;
  voxels.reserve(count);
  internal::hand_out_pages(voxels.data(), count * sizeof(Stored), threads);
  voxels.resize(count);
  return voxels;
}

Volume::Voxels allocate(Storage storage, std::size_t count, int threads) {
  switch (storage) {
    case Storage::as_signed:
      return allocated<std::int16_t>(count, threads);
    case Storage::as_unsigned:
      return allocated<std::uint16_t>(count, threads);
    default:
      return allocated<float>(count, threads);
  }
}

// Padding of a volume of floats: far below any value, so that one range holds for slices of any rescale.
constexpr float float_padding = std::numeric_limits<float>::lowest();

void rescale(const internal::FileHeader& file, const Reading::Rescale& by, std::span<const std::uint16_t> stored,
             std::span<float> values) {
  for (std::size_t i = 0; i < stored.size(); ++i) {
    const double v = file.format.is_signed ? static_cast<std::int16_t>(stored[i]) : stored[i];
    const bool padded = file.padding && v >= file.padding->first && v <= file.padding->second;
    values[i] = padded ? float_padding : static_cast<float>(by.slope * v + by.intercept);
  }
}

// Stored values of a slice -> its place in the volume, rescaled where the volume is of floats.
void place_slice(const Reading& reading, const SeriesSource::Slice& slice, std::span<const std::uint16_t> frame,
                 std::size_t at, Volume::Voxels& voxels) {
  const internal::FileHeader& file = reading.source.file_of(slice);
  const internal::Plane& plane = reading.source.plane_of(slice);
  const auto columns = static_cast<std::size_t>(file.columns);
  for (std::size_t row = 0; row < static_cast<std::size_t>(file.rows); ++row) {
    const auto stored = frame.subspan(
        (plane.tile_row + row) * static_cast<std::size_t>(file.format.columns) + plane.tile_column, columns);
    std::visit(
        [&](auto& v) {
          const auto target = std::span(v).subspan(at + row * columns, columns);
          if constexpr (std::is_same_v<std::decay_t<decltype(v[0])>, float>) {
            rescale(file, reading.rescale_of(slice), stored, target);
          } else {
            std::memcpy(target.data(), stored.data(), target.size_bytes());
          }
        },
        voxels);
  }
}

// Where a whole frame is one slice of 16-bit voxels, it is decoded in place.
std::span<std::uint16_t> in_place(const internal::FileHeader& file, std::size_t at, Volume::Voxels& voxels) {
  if (file.columns != file.format.columns || file.rows != file.format.rows) return {};
  return std::visit(
      [&](auto& v) -> std::span<std::uint16_t> {
        if constexpr (sizeof(v[0]) != 2) return {};
        const std::size_t size = static_cast<std::size_t>(file.columns) * static_cast<std::size_t>(file.rows);
        return {reinterpret_cast<std::uint16_t*>(v.data() + at), size};  // signed and unsigned shorts may alias
      },
      voxels);
}

// Slices that come from one file, by frame: the file is opened once and a mosaic is decoded once.
struct Unit {
  std::vector<std::size_t> slices;  // indices into the frame's slices
};

std::vector<Unit> units_of(const SeriesSource& source, const Slices& slices) {
  constexpr std::size_t most = 16;  // slices a unit, so that all cores share a multi-frame file
  std::vector<std::size_t> order(slices.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
    return std::tuple(slices[a].file, slices[a].plane) < std::tuple(slices[b].file, slices[b].plane);
  });
  std::vector<Unit> units;
  for (const std::size_t k : order) {
    const bool same_file = !units.empty() && slices[units.back().slices.front()].file == slices[k].file;
    const bool same_frame =
        same_file && source.plane_of(slices[units.back().slices.back()]).frame == source.plane_of(slices[k]).frame;
    if (!same_frame && !(same_file && units.back().slices.size() < most)) units.emplace_back();
    units.back().slices.push_back(k);
  }
  return units;
}

// Reads a unit's slices; failed(k, reason) for those that cannot be read.
void read_unit(const Reading& reading, const Unit& unit, Volume::Voxels& voxels,
               const std::function<void(std::size_t, const char*)>& failed) {
  const SeriesSource& source = reading.source;
  const Slices& slices = reading.frame.slices;
  const internal::FileHeader& file = source.file_of(slices[unit.slices.front()]);
  const std::size_t size = static_cast<std::size_t>(file.columns) * static_cast<std::size_t>(file.rows);
  std::optional<internal::PixelReader> reader;
  std::vector<std::uint16_t> frame;
  std::optional<std::uint32_t> held;
  for (const std::size_t k : unit.slices) {
    try {
      if (!reader) reader.emplace(file);
      const std::uint32_t wanted = source.plane_of(slices[k]).frame;
      if (const auto target = in_place(file, k * size, voxels); !target.empty()) {
        reader->read(wanted, target);
        continue;
      }
      if (held != wanted) {
        held.reset();
        frame.resize(static_cast<std::size_t>(file.format.columns) * static_cast<std::size_t>(file.format.rows));
        reader->read(wanted, frame);
        held = wanted;
      }
      place_slice(reading, slices[k], frame, k * size, voxels);
    } catch (const std::exception& error) {
      failed(k, error.what());
    }
  }
}

// A slice that turned out to be unreadable: the later ones move down.
void drop_slices(const std::vector<std::size_t>& failed, std::size_t size, Volume::Voxels& voxels) {
  std::visit(
      [&](auto& v) {
        for (auto k = failed.rbegin(); k != failed.rend(); ++k) {
          const auto first = v.begin() + static_cast<std::ptrdiff_t>(*k * size);
          v.erase(first, first + static_cast<std::ptrdiff_t>(size));
        }
      },
      voxels);
}

/// Throws DicomError where there are no such slices.
LoadOptions::Range checked_range(const SeriesSource::Frame& frame, const std::string& name,
                                 const LoadOptions& options) {
  const int all = static_cast<int>(frame.slices.size());
  const LoadOptions::Range range = options.slices.value_or(LoadOptions::Range{0, all});
  if (range.first < 0 || range.count < 1 || range.count > all - range.first) {
    throw DicomError(name + " has slices 0 to " + std::to_string(all - 1) + ", not " + std::to_string(range.count) +
                     " from " + std::to_string(range.first));
  }
  return range;
}

Geometry geometry_of_slices(Geometry whole, int first, int count) {
  const auto begin = whole.slice_positions.begin() + first;
  whole.slice_positions = std::vector<Vec3>(begin, begin + count);
  whole.dimensions.z = count;
  for (int& gap : whole.gaps) gap -= first;
  std::erase_if(whole.gaps, [&](int gap) { return gap < 0 || gap >= count - 1; });
  return whole;
}

/// `name` is for errors.
Volume read_frame(const Reading& whole, const std::string& name, const LoadOptions& options) {
  const LoadOptions::Range range = checked_range(whole.frame, name, options);
  const auto begin = whole.frame.slices.begin() + range.first;
  const SeriesSource::Frame part{Slices(begin, begin + range.count), {}};
  const Reading reading{whole.source, part, whole.as_velocity};
  const SeriesSource& source = reading.source;
  const Slices& slices = part.slices;
  const internal::FileHeader& first = source.file_of(slices.front());
  const std::size_t size = static_cast<std::size_t>(first.columns) * static_cast<std::size_t>(first.rows);

  Volume volume;
  volume.unit = reading.as_velocity ? "m/s" : first.unit;
  volume.modality = first.modality;
  const Storage storage = storage_for(whole);
  try {
    volume.voxels = allocate(storage, size * slices.size(), options.threads);
  } catch (const std::bad_alloc&) {
    throw DicomError(name + " needs more memory than there is: " + std::to_string(size * slices.size() >> 19) + " MiB");
  }
  if (storage == Storage::as_float) {
    const bool any_padding = std::ranges::any_of(
        whole.frame.slices, [&](const auto& slice) { return source.file_of(slice).padding.has_value(); });
    if (any_padding) volume.padding = {float_padding, float_padding};
  } else {
    const Reading::Rescale by = reading.rescale_of(slices.front());
    volume.slope = by.slope;
    volume.intercept = by.intercept;
    volume.padding = first.padding;
  }

  std::vector<std::size_t> failed;
  std::mutex failed_mutex;
  const auto note_failure = [&](std::size_t k, const char* why) {
    const std::lock_guard lock(failed_mutex);
    failed.push_back(k);
    volume.warnings.push_back(source.file_of(slices[k]).path.filename().string() + " is left out: " + why);
  };
  const std::vector<Unit> units = units_of(source, slices);
  internal::parallel_for(
      units.size(), [&](std::size_t u) { read_unit(reading, units[u], volume.voxels, note_failure); }, options.progress,
      options.threads);
  if (failed.size() == slices.size()) throw DicomError(name + " cannot be read: " + volume.warnings.front());

  std::sort(failed.begin(), failed.end());
  std::sort(volume.warnings.begin(), volume.warnings.end());
  volume.warnings.erase(std::unique(volume.warnings.begin(), volume.warnings.end()), volume.warnings.end());
  drop_slices(failed, size, volume.voxels);

  std::vector<Vec3> positions;
  std::vector<Vec3> lost = whole.frame.lost;
  for (std::size_t k = 0; k < whole.frame.slices.size(); ++k) {
    const bool is_lost = std::ranges::binary_search(failed, k - static_cast<std::size_t>(range.first));
    (is_lost ? lost : positions).push_back(source.plane_of(whole.frame.slices[k]).placement->position);
  }
  volume.geometry = internal::stack_geometry(first.columns, first.rows, *source.plane_of(slices.front()).placement,
                                             std::move(positions), lost, first.thickness);
  if (options.slices) {
    volume.geometry =
        geometry_of_slices(std::move(volume.geometry), range.first, range.count - static_cast<int>(failed.size()));
  }
  return volume;
}

Volume read_velocity(const std::array<SeriesSource::Component, 3>& along, const std::string& name,
                     const LoadOptions& options) {
  std::array<Volume, 3> components;
  std::array<Vec3, 3> directions{};
  for (std::size_t n = 0; n < 3; ++n) {
    const SeriesSource& source = *along[n].source;
    const SeriesSource::Frame& frame = source.frames[along[n].frame];
    directions[n] = source.plane_of(frame.slices.front()).velocity->direction;
    LoadOptions third = options;
    third.slices.reset();
    if (options.progress) {
      third.progress = [&, n](double done) { return options.progress((static_cast<double>(n) + done) / 3); };
    }
    components[n] = read_frame({source, frame, true}, name, third);
  }
  return internal::vector_field(std::move(components), directions);
}

}  // namespace

Volume load(const Series& series, const LoadOptions& options) {
  const std::string name = name_of(series);
  const std::size_t frames =
      series.source ? std::max(series.source->frames.size(), series.source->velocities.size()) : 0;
  if (frames == 0) {
    const std::string why = series.warnings.empty() ? "it has no readable images" : series.warnings.front();
    throw DicomError(name + " cannot be loaded: " + why);
  }
  const auto wanted = static_cast<std::size_t>(options.frame);
  if (options.frame < 0 || wanted >= frames) {
    throw DicomError(name + " has frames 0 to " + std::to_string(frames - 1) + ", not " +
                     std::to_string(options.frame));
  }
  const SeriesSource& source = *series.source;
  if (!source.velocities.empty()) return read_velocity(source.velocities[wanted], name, options);
  return read_frame({source, source.frames[wanted]}, name, options);
}

}  // namespace palpate::io
