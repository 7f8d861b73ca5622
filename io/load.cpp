#include "io/load.h"

#include <algorithm>
#include <mutex>
#include <optional>
#include <set>
#include <utility>

#include "io/dicom/series_source.h"
#include "io/dicom/slice_reader.h"
#include "io/dicom/stacking.h"
#include "io/dicom/velocity.h"
#include "io/errors.h"
#include "io/interchange/voxel_scan.h"
#include "io/messages.h"
#include "io/pages.h"
#include "io/parallel.h"
#include "io/rescaled.h"

namespace palpate::io {
namespace {

using internal::Reading;
using internal::Slices;

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
    const internal::FileHeader& file = reading.source.file_of(slice);
    if (file.format.is_wide() || file.table) return Storage::as_float;
    any_signed |= file.format.is_signed;
    any_large |= !file.format.is_signed && (file.format.bits_stored == 16 || file.padding_is_wide());
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

/// Throws DicomError if there are no such slices.
LoadOptions::Range checked_range(const SeriesSource::Frame& frame, const std::string& name,
                                 const LoadOptions& options) {
  const int all = static_cast<int>(frame.slices.size());
  const LoadOptions::Range range = options.slices.value_or(LoadOptions::Range{0, all});
  if (range.first < 0 || range.count < 1 || range.count > all - range.first) {
    throw DicomError(say("no-such-slice", name, all - 1, range.count, range.first));
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

/// The meaning of the stored numbers: rescale and padding.
void describe_values(const Reading& whole, Storage storage, Volume& volume) {
  const Slices& slices = whole.frame.slices;
  if (storage != Storage::as_float) {
    const Reading::Rescale by = whole.rescale_of(slices.front());
    volume.slope = by.slope;
    volume.intercept = by.intercept;
    volume.padding = whole.source.file_of(slices.front()).padding;
    return;
  }
  const bool any_padding = std::ranges::any_of(slices, [&](const auto& slice) {
    const internal::FileHeader& file = whole.source.file_of(slice);
    return file.padding.has_value() || file.format.is_float;
  });
  if (any_padding) volume.padding = {internal::float_padding, internal::float_padding};
}

/// Reads all slices to their places in the volume and adds its warnings. Returns the slices that cannot be read,
/// ascending. Throws DicomError if none can be.
std::vector<std::size_t> read_slices(const Reading& reading, const std::string& name, const LoadOptions& options,
                                     Volume& volume) {
  std::vector<std::size_t> failed;
  std::set<Text> left_out, oddities;
  std::mutex noting;
  const auto note_failure = [&](std::size_t k, const char* why) {
    const std::lock_guard lock(noting);
    failed.push_back(k);
    const auto& file = reading.source.file_of(reading.frame.slices[k]);
    left_out.insert(say("left-out", file.path.filename().string(), why));
  };
  const auto note_oddity = [&](const Text& what) {
    const std::lock_guard lock(noting);
    oddities.insert(what);
  };
  const std::vector<internal::SliceUnit> units = internal::slice_units(reading);
  internal::parallel_for(
      units.size(),
      [&](std::size_t u) { internal::read_unit(reading, units[u], volume.voxels, note_failure, note_oddity); },
      options.progress, options.threads);
  if (failed.size() == reading.frame.slices.size()) {
    throw DicomError(say("series-cannot-be-read", name, *left_out.begin()));
  }
  std::sort(failed.begin(), failed.end());
  for (const auto& of_slices : {left_out, oddities}) {
    volume.warnings.insert(volume.warnings.end(), of_slices.begin(), of_slices.end());
  }
  return failed;
}

/// `failed`: slices of the range, ascending.
Geometry geometry_of(const Reading& whole, const LoadOptions::Range& range, bool only_range,
                     const std::vector<std::size_t>& failed) {
  const SeriesSource& source = whole.source;
  const Slices& slices = whole.frame.slices;
  std::vector<Vec3> positions;
  std::vector<Vec3> lost = whole.frame.lost;
  for (std::size_t k = 0; k < slices.size(); ++k) {
    const bool is_lost = std::ranges::binary_search(failed, k - static_cast<std::size_t>(range.first));
    (is_lost ? lost : positions).push_back(source.plane_of(slices[k]).placement->position);
  }
  const SeriesSource::Slice& first = slices[static_cast<std::size_t>(range.first)];
  const internal::FileHeader& file = source.file_of(first);
  Geometry geometry = internal::stack_geometry(file.columns, file.rows, *source.plane_of(first).placement,
                                               std::move(positions), lost, file.thickness);
  if (!only_range) return geometry;
  return geometry_of_slices(std::move(geometry), range.first, range.count - static_cast<int>(failed.size()));
}

/// `name` is for errors.
Volume read_frame(const Reading& whole, const std::string& name, const LoadOptions& options) {
  const LoadOptions::Range range = checked_range(whole.frame, name, options);
  const auto begin = whole.frame.slices.begin() + range.first;
  const SeriesSource::Frame part{Slices(begin, begin + range.count), {}};
  const Reading reading{whole.source, part, whole.as_velocity};
  const internal::FileHeader& first = whole.source.file_of(part.slices.front());
  const std::size_t size = static_cast<std::size_t>(first.columns) * static_cast<std::size_t>(first.rows);

  Volume volume;
  volume.unit = reading.as_velocity ? "m/s" : first.unit;
  volume.modality = first.modality;
  volume.frame_of_reference_uid = first.frame_of_reference;
  const Storage storage = storage_for(whole);
  try {
    volume.voxels = allocate(storage, size * part.slices.size(), options.threads);
  } catch (const std::bad_alloc&) {
    const std::size_t bytes = storage == Storage::as_float ? sizeof(float) : sizeof(std::int16_t);
    throw DicomError(say("needs-more-memory-than-there", name, bytes * size * part.slices.size() >> 20));
  }
  describe_values(whole, storage, volume);
  const std::vector<std::size_t> failed = read_slices(reading, name, options, volume);
  drop_slices(failed, size, volume.voxels);
  volume.geometry = geometry_of(whole, range, options.slices.has_value(), failed);
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

Volume load_unnamed(const Series& series, const LoadOptions& options) {
  const std::string name = name_of(series);
  if (series.source && series.source->voxel_file) return load_voxels(*series.source->voxel_file, name, options);
  const std::size_t frames =
      series.source ? std::max(series.source->frames.size(), series.source->velocities.size()) : 0;
  if (frames == 0) {
    const Text why = series.warnings.empty() ? say("no-readable-images") : series.warnings.front();
    throw DicomError(say("series-cannot-be-loaded", name, why));
  }
  const auto wanted = static_cast<std::size_t>(options.frame);
  if (options.frame < 0 || wanted >= frames) {
    throw DicomError(say("no-such-frame", name, frames - 1, options.frame));
  }
  const SeriesSource& source = *series.source;
  if (!source.velocities.empty()) return read_velocity(source.velocities[wanted], name, options);
  return read_frame({source, source.frames[wanted]}, name, options);
}

}  // namespace

Volume load(const Series& series, const LoadOptions& options) {
  Volume volume = load_unnamed(series, options);
  volume.patient_id = series.identity.patient_id;
  volume.patient_name = series.identity.patient_name;
  volume.body_part = series.details.body_part;
  volume.description = series.description;
  if (options.is_rescaled) return rescaled(std::move(volume));
  return volume;
}

}  // namespace palpate::io
