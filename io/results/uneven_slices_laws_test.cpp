// Segmentations on uneven slices, written and read back: the distances are those of the same voxels in memory.

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <glm/common.hpp>
#include <string>
#include <utility>
#include <vector>

#include "io/structures/distance_field.h"
#include "io/structures/mask.h"
#include "io/structures/structure.h"
#include "io/testing/outlined_scan.h"
#include "io/testing/written_outline.h"

namespace palpate::io {
namespace {

using testing::scan_kind;
using testing::ScanKind;

/// Its voxels, on the box around those that are inside.
Mask mask_of(const LabelImage& image) {
  Mask mask;
  mask.geometry = image.geometry;
  glm::ivec3 low = image.geometry.dimensions, high(-1);
  const auto for_voxels = [](const glm::ivec3& from, const glm::ivec3& to, const auto& work) {
    for (int k = from.z; k <= to.z; ++k) {
      for (int j = from.y; j <= to.y; ++j) {
        for (int i = from.x; i <= to.x; ++i) work(glm::ivec3(i, j, k));
      }
    }
  };
  for_voxels(glm::ivec3(0), image.geometry.dimensions - 1, [&](const glm::ivec3& at) {
    if (image.inside[image.offset(at.x, at.y, at.z)] == 0) return;
    low = glm::min(low, at);
    high = glm::max(high, at);
  });
  mask.low = low;
  mask.size = high - low + 1;
  for_voxels(low, high, [&](const glm::ivec3& at) {
    mask.occupancy.push_back(image.inside[image.offset(at.x, at.y, at.z)] != 0 ? Mask::full : 0);
  });
  return mask;
}

/// Slices with a gap at each place, with two distances, and with any.
std::vector<ScanKind> uneven_scans() {
  std::vector<ScanKind> kinds{scan_kind("uneven"), scan_kind("slices missing"), scan_kind("tilted")};
  const Vec3 first(-10, 20, 30);
  for (int lost = 2; lost < 8; ++lost) {
    ScanKind kind{"slice " + std::to_string(lost) + " lost", {1, 0, 0}, {0, 1, 0}, {}};
    for (int k = 0; k < 10; ++k) {
      if (k != lost) kind.positions.push_back(first + Vec3(0, 0, 1.5 * k));
    }
    kinds.push_back(kind);
  }
  for (const auto& [near, far] : {std::pair{1.0, 2.0}, {1.0, 3.0}, {1.2, 2.0}}) {
    ScanKind kind{fmt::format("{} and {} mm", near, far), {1, 0, 0}, {0, 1, 0}, {}};
    for (int k = 0; k < 10; ++k) {
      kind.positions.push_back(first + Vec3(0, 0, k < 5 ? k * near : 5 * near + (k - 5) * far));
    }
    kinds.push_back(kind);
  }
  return kinds;
}

// A step over a lost slice and a larger slice distance are steps like any other: no slice is between, and none is
// empty.
TEST(UnevenSlices, AreReadWithTheSameDistances) {
  testing::for_written(uneven_scans(), [](const testing::WrittenShape& written, const Structure& read) {
    const auto& [kind, shape, scan, image] = written;
    DistanceOptions distance;
    distance.scan = &scan.geometry;
    const auto before = distance_of(mask_of(image), distance);
    const auto field = load_distance(read, distance), alone = load_distance(read);
    double most = 0;
    const glm::ivec3& n = scan.geometry.dimensions;
    std::size_t inside = 0, cut = 0;
    for (int k = 0; k + 1 < n.z; ++k) {
      for (int j = 0; j < n.y; ++j) {
        for (int i = 0; i < n.x; ++i) {
          for (const double between : {0.0, 0.5}) {
            const Vec3 at = scan.geometry.to_patient(Vec3(i, j, k + between));
            const double mm = before->sample(at).mm;
            if (std::abs(mm) < 3) most = std::max(most, std::abs(field->sample(at).mm - mm));
          }
          if (image.inside[image.offset(i, j, k)] == 0 || image.inside[image.offset(i, j, k + 1)] == 0) continue;
          ++inside;
          cut += alone->sample(scan.geometry.to_patient(Vec3(i, j, k + 0.5))).mm < -0.25 ? 1 : 0;
        }
      }
    }
    const bool on_nodes = kind.name != "uneven" && kind.name != "1.2 and 2 mm";
    EXPECT_LT(most, on_nodes ? 0.01 : 2.0);
    if (shape.name != "shell and ball") {  // thinner than a step over a lost slice
      EXPECT_LE(cut * 50, inside) << "without the scan, too";
    }
    EXPECT_NEAR(measure(read, &scan.geometry).volume_mm3, testing::sums_of(image).volume_mm3, 0.01);
  });
}

}  // namespace
}  // namespace palpate::io
