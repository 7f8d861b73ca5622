#include "io/structures/label_image.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>
#include <utility>

#include "io/errors.h"
#include "io/interchange/voxel_file.h"
#include "io/messages.h"
#include "io/parallel.h"
#include "io/structures/grid_box.h"
#include "io/structures/write_checks.h"

namespace palpate::io {

IndexBox index_box(const Geometry& scan, const std::optional<StructureBox>& within) {
  IndexBox box{glm::ivec3(0), scan.dimensions - 1};
  if (!within) return box;
  Vec3 low(std::numeric_limits<double>::infinity()), high = -low;
  for (int corner = 0; corner < 8; ++corner) {
    const auto end = [&](int axis) { return (corner >> axis) % 2 == 0 ? within->low_mm[axis] : within->high_mm[axis]; };
    const Vec3 index = scan.to_index({end(0), end(1), end(2)});
    low = glm::min(low, index);
    high = glm::max(high, index);
  }
  for (int axis = 0; axis < 3; ++axis) {
    const double last = scan.dimensions[axis] - 1;
    // Beyond the box by a voxel: slices may be uneven or sheared, and a box may be of voxel centers.
    box.low[axis] = static_cast<int>(std::clamp(std::floor(low[axis]) - 1, 0.0, last));
    box.high[axis] = static_cast<int>(std::clamp(std::ceil(high[axis]) + 1, 0.0, last));
  }
  return box;
}

LabelImage sample_labels(StructureLabel label, const Geometry& scan, const SignedDistance& distance,
                         const std::optional<StructureBox>& within, const Progress& progress) {
  LabelImage image{.label = std::move(label), .geometry = scan, .inside = {}};
  const glm::ivec3& n = scan.dimensions;
  image.inside.resize(static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y) * static_cast<std::size_t>(n.z));
  const IndexBox box = index_box(scan, within);
  const int rows = box.high.y - box.low.y + 1;
  const auto count = static_cast<std::size_t>(rows) * static_cast<std::size_t>(box.high.z - box.low.z + 1);
  internal::parallel_for(
      count,
      [&](std::size_t row) {
        const int j = box.low.y + static_cast<int>(row) % rows, k = box.low.z + static_cast<int>(row) / rows;
        for (int i = box.low.x; i <= box.high.x; ++i) {
          image.inside[image.offset(i, j, k)] = distance(scan.to_patient(Vec3(i, j, k))) > 0 ? 1 : 0;
        }
      },
      progress, 0);
  return image;
}

void check_target(const StructureLabel& label, const std::filesystem::path& file, const WriteOptions& options) {
  check_may_write(file, existing(options));
  std::error_code not_there;
  if (label.origin && std::filesystem::equivalent(label.origin->file, file, not_there)) {
    throw DicomError(say("file-is-what-was-corrected", file.string()));
  }
}

std::pair<int, int> occupied_slices(const LabelImage& image) {
  const auto is_inside = [](std::uint8_t voxel) { return voxel != 0; };
  const auto first = std::ranges::find_if(image.inside, is_inside);
  if (first == image.inside.end()) throw DicomError(say("outline-is-empty", image.label.name));
  const auto last = std::find_if(image.inside.rbegin(), image.inside.rend(), is_inside);
  const auto slice = static_cast<std::ptrdiff_t>(image.offset(0, 0, 1));
  return {static_cast<int>((first - image.inside.begin()) / slice),
          static_cast<int>((last.base() - image.inside.begin() - 1) / slice)};
}

StructureForm form_of(const std::filesystem::path& file, bool rtstruct) {
  if (has_ending(file, ".dcm")) return rtstruct ? StructureForm::contours : StructureForm::segmentation;
  if (rtstruct) throw DicomError(say("contours-are-dicom-alone", file.filename().string()));
  if (writer_of(file)) return StructureForm::label_map;
  throw_no_known_ending(file);
}

}  // namespace palpate::io
