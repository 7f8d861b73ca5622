#include "io/dicom/grouping.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <set>

#include "io/dicom/copies.h"
#include "io/dicom/frames.h"
#include "io/dicom/series_source.h"
#include "io/dicom/stack_parts.h"
#include "io/dicom/stacking.h"
#include "io/dicom/torn_series.h"
#include "io/fields/gradient.h"
#include "io/messages.h"

namespace palpate::io::internal {
namespace {

using Slice = SeriesSource::Slice;

constexpr double spacing_tolerance = 1e-3;  // half a pixel at the end of 512

/// Places are comparable where both files give them in one frame of reference; where one does not say, its series does.
bool share_frame_of_reference(const FileHeader& a, const FileHeader& b) {
  return a.frame_of_reference == b.frame_of_reference || a.frame_of_reference.empty() || b.frame_of_reference.empty();
}

bool fit_together(const SeriesSource& source, const Slice& a, const Slice& b) {
  const FileHeader& fa = source.file_of(a);
  const FileHeader& fb = source.file_of(b);
  const Placement& x = *source.plane_of(a).placement;
  const Placement& y = *source.plane_of(b).placement;
  return fa.columns == fb.columns && fa.rows == fb.rows && fa.modality == fb.modality &&
         share_frame_of_reference(fa, fb) && are_parallel(x, y) &&
         std::abs(x.spacing_i - y.spacing_i) < spacing_tolerance * x.spacing_i &&
         std::abs(x.spacing_j - y.spacing_j) < spacing_tolerance * x.spacing_j;
}

void describe(const FileHeader& file, Series& series) {
  series.uid = file.series;
  series.study_uid = file.study;
  series.modality = file.modality;
  series.description = file.description;
  series.unit = file.unit;
  series.identity = file.identity;
  series.details = file.details;
}

// What files say alike is said once.
void add_remarks(const SeriesSource& source, const std::vector<Slice>& slices, Series& series) {
  std::set<std::uint32_t> seen;
  for (const Slice& slice : slices) {
    if (!seen.insert(slice.file).second) continue;
    for (const Text& remark : source.file_of(slice).remarks) {
      const bool is_new = std::find(series.warnings.begin(), series.warnings.end(), remark) == series.warnings.end();
      if (is_new) series.warnings.push_back(remark);
    }
  }
}

void list_files(const SeriesSource& source, const std::vector<Slice>& slices, Series& series) {
  std::set<std::uint32_t> listed;
  std::set<std::string> syntaxes;
  for (const Slice& slice : slices) {
    const FileHeader& file = source.file_of(slice);
    if (listed.insert(slice.file).second) series.files.push_back(file.path);
    syntaxes.insert(file.transfer_syntax);
  }
  series.transfer_syntaxes.assign(syntaxes.begin(), syntaxes.end());
}

Text why_unusable(const SeriesSource& source) {
  const auto& slices = source.frames.front().slices;
  if (slices.empty()) return say("none-of-its-images-can-be-read");
  const FileHeader& file = source.file_of(slices.front());
  if (file.image_type.find("LOCALIZER") != std::string::npos) return say("localizer-no-volume");
  if (slices.size() == 1) return say("one-slice-alone-is-no-volume");
  return {};
}

Geometry geometry_of(const SeriesSource& source, const SeriesSource::Frame& frame, const Slice& example) {
  std::vector<Vec3> positions;
  for (const Slice& slice : frame.slices) positions.push_back(source.plane_of(slice).placement->position);
  const FileHeader& file = source.file_of(example);
  return stack_geometry(file.columns, file.rows, *source.plane_of(example).placement, std::move(positions), frame.lost,
                        file.thickness);
}

// The frames of each part, with the slices of damaged files as lost; returns the slices that can be read.
std::vector<Slice> add_frames(const std::vector<const StackPart*>& parts, SeriesSource& source, Series& series,
                              std::vector<Slice>& left_over) {
  std::vector<Slice> read;
  for (const StackPart* part : parts) {
    FrameSplit split = split_into_frames(source, part->slices);
    left_over.insert(left_over.end(), split.left_over.begin(), split.left_over.end());
    for (std::size_t f = 0; f < split.frames.size(); ++f) {
      SeriesSource::Frame& frame = source.frames.emplace_back();
      frame.lost = std::move(split.lacking[f]);
      for (const Slice& slice : split.frames[f]) {
        if (source.file_of(slice).defect.empty()) {
          frame.slices.push_back(slice);
          read.push_back(slice);
        } else {
          frame.lost.push_back(source.plane_of(slice).placement->position);
        }
      }
      const std::string& name = split.names[f];
      const bool both = parts.size() > 1 && !name.empty();
      series.frame_names.push_back(parts.size() > 1 ? part->name + (both ? ", " : "") + name : name);
    }
  }
  return read;
}

// A frame without any remaining slice is dropped; the others stay.
void drop_empty_frames(SeriesSource& source, Series& series) {
  const auto most = std::ranges::max(source.frames, {}, [](const auto& f) { return f.slices.size(); }).slices.size();
  for (std::size_t f = source.frames.size(); f-- > 0 && most > 1;) {
    const SeriesSource::Frame& frame = source.frames[f];
    if (frame.slices.size() > 1) continue;
    const std::string& name = series.frame_names[f];
    series.warnings.push_back(say("frame-left-out", (name.empty() ? "frame " + std::to_string(f) : name),
                                  frame.slices.size(), frame.slices.size() + frame.lost.size()));
    source.frames.erase(source.frames.begin() + static_cast<std::ptrdiff_t>(f));
    series.frame_names.erase(series.frame_names.begin() + static_cast<std::ptrdiff_t>(f));
  }
}

// Frames of one volume may lie a little apart, where the scanner followed a head.
void remark_on_moving_frames(const SeriesSource& source, Series& series) {
  double apart = 0;
  const Placement* reference = nullptr;
  std::array<double, 2> first{};
  for (const SeriesSource::Frame& frame : source.frames) {
    if (frame.slices.empty() || !frame.lost.empty()) continue;
    const auto height = [&](const Slice& s) { return height_of(source.plane_of(s).placement->position, *reference); };
    if (reference == nullptr) {
      reference = &*source.plane_of(frame.slices.front()).placement;
      first = {height(frame.slices.front()), height(frame.slices.back())};
    }
    if (frame.slices.size() != source.frames.front().slices.size()) continue;
    apart = std::max(
        {apart, std::abs(height(frame.slices.front()) - first[0]), std::abs(height(frame.slices.back()) - first[1])});
  }
  if (reference != nullptr && apart > same_place_mm(*reference)) {
    series.warnings.push_back(say("frames-lie-apart", millimeters(apart)));
  }
}

// The gradient spans slices up to a distance; beyond it, edges are found in the slices alone.
void remark_on_wide_gaps(Series& series) {
  const Geometry& g = series.geometry;
  constexpr double spans = 2;  // scales, from which on the next slice has little weight
  if (g.dimensions.z < 2 || g.slice_spacing() <= spans * largest_gradient_scale_mm(g)) return;
  series.warnings.push_back(
      say("slices-far-apart", millimeters(g.slice_spacing()), millimeters(std::min(g.spacing_i, g.spacing_j))));
}

std::string compression_of(const Series::Details& details) {
  if (!(details.compression_ratio > 0)) return {};
  const auto tenths = std::llround(10 * std::min(details.compression_ratio, 1e6));
  return " of " + std::to_string(tenths / 10) + "." + std::to_string(tenths % 10) + " to 1";
}

// Remarks on acquisitions whose values may feel different from what a user expects.
void remark_on_acquisition(Series& series) {
  const Series::Details& details = series.details;
  const double apart = series.geometry.slice_spacing();
  constexpr double wide = 1.5;  // thicknesses; less is what MR leaves between slices anyway
  if (details.thickness_mm > 0 && series.geometry.dimensions.z > 1 && apart > wide * details.thickness_mm) {
    series.warnings.push_back(say("slices-have-gaps", millimeters(details.thickness_mm), millimeters(apart)));
  }
  if (details.is_projection) {
    series.warnings.push_back(say("slices-are-projections"));
  } else if (details.is_derived) {
    series.warnings.push_back(say("images-were-computed-from-others"));
  }
  if (details.is_lossy) {
    series.warnings.push_back(say("lossy-compression-fine-edges-may-be-artifacts", compression_of(details)));
  }
  if (series.modality == "PT") {
    series.warnings.push_back(say("pet-its-values-are-uptake"));
  }
}

// Stacks of images that fit together, as a series with its frames.
Series make_series(const SeriesSource& files, const std::vector<const StackPart*>& parts,
                   std::vector<SkippedFile>& skipped) {
  Series series;
  std::vector<Slice> stack;
  for (const StackPart* part : parts) stack.insert(stack.end(), part->slices.begin(), part->slices.end());
  describe(files.file_of(stack.front()), series);
  auto source = std::make_shared<SeriesSource>(files);
  std::vector<Slice> left_over;
  const std::vector<Slice> read = add_frames(parts, *source, series, left_over);
  drop_empty_frames(*source, series);
  std::set<std::uint32_t> unreadable;
  for (const Slice& slice : stack) {
    if (!source->file_of(slice).defect.empty()) unreadable.insert(slice.file);
  }
  for (const std::uint32_t file : unreadable) {
    const FileHeader& header = (*source->files)[file];
    series.warnings.push_back(say("left-out", name_of(header), header.defect));
  }
  for (const Slice& slice : left_over) {
    const FileHeader& file = source->file_of(slice);
    if (!file.defect.empty()) continue;
    skipped.push_back({file.path, say("another-image-of-its-series-lies")});
    series.warnings.push_back(say("left-out-same-position", name_of(file)));
  }

  add_remarks(*source, stack, series);
  list_files(*source, read, series);
  series.frames_per_position = static_cast<int>(source->frames.size());
  series.geometry = geometry_of(*source, source->frames.front(), stack.front());
  for (auto& warning : geometry_warnings(series.geometry, files.file_of(stack.front()).thickness)) {
    series.warnings.push_back(std::move(warning));
  }
  remark_on_moving_frames(*source, series);
  remark_on_wide_gaps(series);
  series.details.orientation = orientation_of(series.geometry);
  remark_on_acquisition(series);
  for (std::size_t f = 1; f < source->frames.size(); ++f) {
    if (source->frames[f].slices.size() == source->frames.front().slices.size()) continue;
    series.warnings.push_back(
        say("frame-lacks-slices", f, source->frames[f].slices.size(), source->frames.front().slices.size()));
  }
  if (const auto& slices = source->frames.front().slices; !slices.empty()) {
    series.window = source->plane_of(slices[slices.size() / 2]).window;
  }
  const Text why = why_unusable(*source);
  series.usable = why.empty();
  if (!series.usable) series.warnings.insert(series.warnings.begin(), why);
  if (source->frames.front().slices.empty()) source->frames.clear();
  series.source = std::move(source);
  return series;
}

// Groups images that fit together into one series or, for interleaved stacks, into several.
std::vector<Series> series_of(const SeriesSource& files, const std::vector<Slice>& stack,
                              std::vector<SkippedFile>& skipped) {
  const PartedStack parted = part_stack(files, stack);
  std::map<int, std::vector<const StackPart*>> volumes;
  for (const StackPart& part : parted.parts) volumes[part.volume].push_back(&part);
  std::vector<Series> result;
  for (const auto& [number, parts] : volumes) {
    Series& series = result.emplace_back(make_series(files, parts, skipped));
    if (volumes.size() > 1) series.part = parts.front()->name;
    series.warnings.insert(series.warnings.end(), parted.doubts.begin(), parted.doubts.end());
  }
  return result;
}

// All files of one series.
void group_one_series(std::vector<FileHeader> headers, std::vector<Series>& result, std::vector<SkippedFile>& skipped) {
  SeriesSource source;
  std::vector<std::filesystem::path> all_paths;
  all_paths.reserve(headers.size());
  for (FileHeader& header : headers) all_paths.push_back(header.path);
  source.files = std::make_shared<const std::vector<FileHeader>>(drop_copies(std::move(headers), skipped));
  std::vector<std::vector<Slice>> stacks;
  for (std::uint32_t f = 0; f < source.files->size(); ++f) {
    const FileHeader& file = (*source.files)[f];
    if (!file.unfit.empty() || !file.defect.empty())
      skipped.push_back({file.path, file.unfit.empty() ? file.defect : file.unfit});
    if (!file.unfit.empty()) continue;
    for (std::uint32_t p = 0; p < file.planes.size(); ++p) {
      if (!file.planes[p].placement) continue;
      const auto stack = std::find_if(stacks.begin(), stacks.end(), [&](const std::vector<Slice>& s) {
        return fit_together(source, s.front(), {f, p});
      });
      (stack == stacks.end() ? stacks.emplace_back() : *stack).push_back({f, p});
    }
  }
  if (stacks.empty()) return;

  std::vector<Series> found;
  found.reserve(stacks.size());
  for (const auto& stack : stacks) {
    for (Series& series : series_of(source, stack, skipped)) found.push_back(std::move(series));
  }
  const auto first_unusable =
      std::stable_partition(found.begin(), found.end(), [](const Series& s) { return s.usable; });
  if (first_unusable == found.begin()) {
    // Without a volume the series is listed once, with all its files, so that a user finds it.
    Series& whole = *std::max_element(found.begin(), found.end(),
                                      [](const Series& a, const Series& b) { return a.files.size() < b.files.size(); });
    whole.files = all_paths;
    result.push_back(std::move(whole));
    return;
  }
  for (auto unusable = first_unusable; unusable != found.end(); ++unusable) {
    for (const auto& path : unusable->files) {
      skipped.push_back({path, say("does-not-fit-the-volume", unusable->warnings.front())});
    }
  }
  std::move(found.begin(), first_unusable, std::back_inserter(result));
}

}  // namespace

std::string orientation_of(const Geometry& geometry) {
  const Vec3 normal = glm::abs(glm::normalize(glm::cross(geometry.direction_i, geometry.direction_j)));
  constexpr double along = 0.94;  // within 20 degrees
  if (normal.z > along) return "axial";
  if (normal.y > along) return "coronal";
  return normal.x > along ? "sagittal" : "oblique";
}

std::vector<Series> group_into_series(std::vector<FileHeader> headers, std::vector<SkippedFile>& skipped) {
  join_torn_series(headers);
  // Anonymised scans may share a series UID, or have none: patients, studies and folders are never mixed.
  const auto key_of = [](const FileHeader& file) {
    std::string key = file.series + '\n' + file.study + '\n' + file.identity.patient_id;
    if (file.series.empty()) key += '\n' + file.description + '\n' + file.path.parent_path().string();
    return key;
  };
  std::vector<std::string> order;
  std::map<std::string, std::vector<FileHeader>> by_series;
  for (FileHeader& header : headers) {
    auto& files = by_series[key_of(header)];
    if (files.empty()) order.push_back(key_of(header));
    files.push_back(std::move(header));
  }
  std::vector<Series> series;
  for (const std::string& key : order) group_one_series(std::move(by_series[key]), series, skipped);
  return series;
}

}  // namespace palpate::io::internal
