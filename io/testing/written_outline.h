#pragma once

/// Reads an outline that a test has written.

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcitem.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <filesystem>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/structures/label_image.h"
#include "io/structures/structure.h"
#include "io/testing/outlined_scan.h"

namespace palpate::io::testing {

inline Structure only_structure_in(const std::filesystem::path& file) {
  const StructureCatalogue found = find_structures(std::array{file});
  if (found.structures.size() != 1) {
    std::string why = "not one structure";
    for (const SkippedFile& one : found.skipped) why += ": " + one.reason;
    throw std::runtime_error(why);
  }
  return found.structures.front();
}

inline std::string tag_text(DcmItem& item, const DcmTagKey& key) {
  OFString value;
  item.findAndGetOFStringArray(key, value);
  return value.c_str();
}

struct WrittenShape {
  const ScanKind& kind;
  const Shape& shape;
  const Series& scan;
  const LabelImage& image;
};

/// Writes each shape on each scan as a segmentation, and calls `work` with what was written and what was read.
template <typename Work>
void for_written(const std::vector<ScanKind>& kinds, const Work& work) {
  for (const ScanKind& kind : kinds) {
    const internal::TestFolder folder;
    const Series scan = write_scan(kind, folder / "scan");
    for (const Shape& shape : shapes_in(scan.geometry)) {
      SCOPED_TRACE(kind.name + ", " + shape.name);
      const std::filesystem::path file = folder / (shape.name + ".dcm");
      const LabelImage image = sample_labels(full_label(), scan.geometry, shape.distance);
      write_segmentation(image, scan, file, by_test);
      work(WrittenShape{kind, shape, scan, image}, only_structure_in(file));
    }
  }
}

/// The volume and the centroid of an image's voxels, each of which reaches half of the way to the slices beside its
/// own.
struct VoxelSums {
  std::size_t inside = 0;
  double volume_mm3 = 0;
  Vec3 centroid_mm{0};
};

inline VoxelSums sums_of(const LabelImage& image) {
  const Geometry& g = image.geometry;
  const Vec3 normal = glm::normalize(glm::cross(g.direction_i, g.direction_j));
  const auto apart = [&](int slice) {
    if (g.dimensions.z < 2) return g.slice_spacing();
    const auto at = static_cast<std::size_t>(std::clamp(slice, 0, g.dimensions.z - 2));
    return glm::dot(g.slice_positions[at + 1] - g.slice_positions[at], normal);
  };
  VoxelSums sums;
  for (std::size_t n = 0; n < image.inside.size(); ++n) {
    if (image.inside[n] == 0) continue;
    const auto i = static_cast<int>(n) % g.dimensions.x, j = static_cast<int>(n) / g.dimensions.x % g.dimensions.y;
    const int k = static_cast<int>(n) / g.dimensions.x / g.dimensions.y;
    const double below = 0.5 * apart(k - 1), above = 0.5 * apart(k);
    const double volume = (below + above) * g.spacing_i * g.spacing_j;
    ++sums.inside;
    sums.volume_mm3 += volume;
    sums.centroid_mm += volume * (g.to_patient(Vec3(i, j, k)) + 0.5 * (above - below) * normal);
  }
  sums.centroid_mm /= sums.volume_mm3;
  return sums;
}

/// Checks that every voxel was read. On a grid at right angles, every voxel's center has to be on its own side in the
/// reader's field. On a tilted grid only the number of voxels and their centroid are compared; pydicom compares all of
/// them (outline_peers_test.cpp).
inline void expect_same_voxels(const LabelImage& written, const Structure& read, bool is_straight) {
  DistanceOptions distance;
  distance.scan = &written.geometry;
  const auto field = load_distance(read, distance);
  const glm::ivec3& n = written.geometry.dimensions;
  std::size_t wrong = 0;
  for (int k = 0; k < n.z; ++k) {
    for (int j = 0; j < n.y; ++j) {
      for (int i = 0; i < n.x; ++i) {
        const bool was = written.inside[written.offset(i, j, k)] != 0;
        const Vec3 at = written.geometry.to_patient(Vec3(i, j, k));
        const bool is = field->sample(at).mm > 0;
        wrong += was != is ? 1 : 0;
      }
    }
  }
  if (is_straight) {
    EXPECT_EQ(wrong, 0U);
  }
  const StructureMeasures measures = measure(read, &written.geometry);
  const VoxelSums sums = sums_of(written);
  EXPECT_EQ(measures.voxels, sums.inside);
  EXPECT_NEAR(measures.volume_mm3, sums.volume_mm3, 1e-5 * sums.volume_mm3);
  EXPECT_LT(glm::length(measures.centroid_mm - sums.centroid_mm), 1e-5);
}

}  // namespace palpate::io::testing
