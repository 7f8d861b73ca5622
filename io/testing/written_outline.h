#pragma once

/// Reads an outline that a test has written.

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcitem.h>
#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <string>

#include "io/structures/structure.h"

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

/// The reader's field has every voxel's center on its side where the grid is at right angles: so it has read every
/// voxel. On a tilted one it has their number and their center; pydicom has them all (outline_peers_test.cpp).
inline void expect_same_voxels(const LabelImage& written, const Structure& read, bool is_straight) {
  DistanceOptions distance;
  distance.scan = &written.geometry;
  const auto field = load_distance(read, distance);
  const glm::ivec3& n = written.geometry.dimensions;
  std::size_t inside = 0, wrong = 0;
  Vec3 sum(0);
  for (int k = 0; k < n.z; ++k) {
    for (int j = 0; j < n.y; ++j) {
      for (int i = 0; i < n.x; ++i) {
        const bool was = written.inside[written.offset(i, j, k)] != 0;
        const Vec3 at = written.geometry.to_patient(Vec3(i, j, k));
        const bool is = field->sample(at).mm > 0;
        wrong += was != is ? 1 : 0;
        inside += was ? 1 : 0;
        sum += was ? at : Vec3(0);
      }
    }
  }
  if (is_straight) {
    EXPECT_EQ(wrong, 0U);
  }
  const StructureMeasures measures = measure(read);
  EXPECT_EQ(measures.voxels, inside);
  EXPECT_LT(glm::length(measures.centroid_mm - sum / static_cast<double>(inside)), 1e-6);
}

}  // namespace palpate::io::testing
