#include "palpate/io/internal/grouping.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <set>
#include <tuple>

#include "palpate/io/internal/series_source.h"
#include "palpate/io/internal/stacking.h"

namespace palpate::io::internal {
namespace {

using Slice = SeriesSource::Slice;

// Cosines of one series may differ in their last digits from file to file.
constexpr double direction_tolerance = 1e-3;

bool fits(const FileHeader& a, const Plane& pa, const FileHeader& b, const Plane& pb) {
  const Placement& x = *pa.placement;
  const Placement& y = *pb.placement;
  return a.format.columns == b.format.columns && a.format.rows == b.format.rows &&
         glm::length(x.direction_i - y.direction_i) < direction_tolerance &&
         glm::length(x.direction_j - y.direction_j) < direction_tolerance &&
         std::abs(x.spacing_i - y.spacing_i) < 1e-4 * x.spacing_i &&
         std::abs(x.spacing_j - y.spacing_j) < 1e-4 * x.spacing_j;
}

void describe(const FileHeader& file, Series& series) {
  series.uid = file.series;
  series.study_uid = file.study;
  series.modality = file.modality;
  series.description = file.description;
  series.unit = file.unit;
  series.identity = file.identity;
}

Series make_series(std::vector<FileHeader> files, std::vector<SkippedFile>& skipped) {
  Series series;
  describe(files.front(), series);
  auto source = std::make_shared<SeriesSource>();
  SeriesSource::Frame frame;
  std::set<std::string> syntaxes;

  std::vector<Slice> all;
  source->files = std::move(files);
  for (std::uint32_t f = 0; f < source->files.size(); ++f) all.push_back({f, 0});
  const Placement reference = *source->plane_of(all.front()).placement;
  const auto height = [&](const Slice& s) { return height_of(source->plane_of(s).placement->position, reference); };
  std::stable_sort(all.begin(), all.end(), [&](const Slice& a, const Slice& b) { return height(a) < height(b); });

  const double same_place = 0.02 * std::min(reference.spacing_i, reference.spacing_j);
  for (const Slice& slice : all) {
    const FileHeader& file = source->file_of(slice);
    if (!file.defect.empty()) {
      skipped.push_back({file.path, file.defect});
      frame.lost.push_back(source->plane_of(slice).placement->position);
      series.warnings.push_back(file.path.filename().string() + " is left out: " + file.defect);
    } else if (!frame.slices.empty() && height(slice) - height(frame.slices.back()) < same_place) {
      series.warnings.push_back(file.path.filename().string() + " is left out: another image lies at its position");
      skipped.push_back({file.path, "another image of its series lies at its position"});
    } else {
      frame.slices.push_back(slice);
      series.files.push_back(file.path);
      syntaxes.insert(file.transfer_syntax);
    }
  }
  series.transfer_syntaxes.assign(syntaxes.begin(), syntaxes.end());
  std::vector<Vec3> positions;
  for (const Slice& slice : frame.slices) positions.push_back(source->plane_of(slice).placement->position);
  series.geometry = stack_geometry(source->files.front().format.columns, source->files.front().format.rows, reference,
                                   std::move(positions), frame.lost, source->files.front().thickness);
  for (auto& warning : geometry_warnings(series.geometry)) series.warnings.push_back(std::move(warning));

  series.usable = frame.slices.size() >= 2;
  if (!series.usable) series.warnings.push_back("one slice alone is no volume");
  if (!frame.slices.empty()) source->frames.push_back(std::move(frame));
  series.source = std::move(source);
  return series;
}

}  // namespace

std::vector<Series> group_into_series(std::vector<FileHeader> headers, std::vector<SkippedFile>& skipped) {
  std::vector<std::vector<FileHeader>> groups;
  for (FileHeader& header : headers) {
    if (!header.unfit.empty()) {
      skipped.push_back({header.path, header.unfit});
      continue;
    }
    const auto group = std::find_if(groups.begin(), groups.end(), [&](const std::vector<FileHeader>& g) {
      return g.front().series == header.series &&
             fits(g.front(), g.front().planes.front(), header, header.planes.front());
    });
    if (group == groups.end()) {
      groups.emplace_back().push_back(std::move(header));
    } else {
      group->push_back(std::move(header));
    }
  }
  std::vector<Series> series;
  for (auto& group : groups) series.push_back(make_series(std::move(group), skipped));
  return series;
}

}  // namespace palpate::io::internal
