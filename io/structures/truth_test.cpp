// The shared structures against the results of pydicom, nibabel and numpy.
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "io/structures/structure.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using Json = nlohmann::json;

const fs::path shared = fs::path(PALPATE_SHARED_DATA) / "structures";

Structure structure_in(const fs::path& file, int number) {
  for (const Structure& structure : find_structures(std::array{file}).structures) {
    if (structure.number == number) return structure;
  }
  ADD_FAILURE() << file << " has no structure " << number;
  return {};
}

void expect_near(const Vec3& a, const Json& b) {
  for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(a[axis], b.at(static_cast<std::size_t>(axis)).get<double>(), 1e-3);
}

TEST(SharedStructuresTruth, MeetsEverySegmentation) {
  if (!fs::exists(shared / "truth.json"))
    GTEST_SKIP() << "needs the shared structures, which are not beside this checkout";
  std::ifstream file(shared / "truth.json");
  const Json truth = Json::parse(file);
  int met = 0;
  for (const auto& [name, entry] : truth.items()) {
    for (const auto& [number, segment] : entry.at("segments").items()) {
      SCOPED_TRACE(name);
      const Structure structure = structure_in(shared / name, std::stoi(number));
      if (segment.contains("name")) {
        EXPECT_EQ(structure.name, segment.at("name").get<std::string>());
      }
      EXPECT_EQ(structure.frame_of_reference_uid, entry.value("frame_of_reference", ""));
      const StructureMeasures measures = measure(structure);
      EXPECT_EQ(measures.voxels, segment.at("voxels").get<std::uint64_t>());
      EXPECT_NEAR(measures.volume_mm3, segment.at("mm3").get<double>(), 1e-5 * measures.volume_mm3);
      expect_near(measures.centroid_mm, segment.at("centroid"));
      expect_near(measures.box_low_mm, segment.at("low"));
      expect_near(measures.box_high_mm, segment.at("high"));
      ++met;
    }
  }
  EXPECT_GE(met, 39);
}

TEST(SharedStructuresTruth, HasADistanceThatGoesOnWhereTheScanEnds) {
  if (!fs::exists(shared / "truth.json"))
    GTEST_SKIP() << "needs the shared structures, which are not beside this checkout";
  const Structure liver = structure_in(shared / "dcmqi" / "liver.dcm", 1);
  const Catalogue scans = find_series(std::array{shared / "dcmqi" / "ct-3slice"});
  ASSERT_EQ(scans.series.size(), 1U);
  DistanceOptions options;
  options.scan = &scans.series.front().geometry;
  const auto field = load_distance(liver, options);
  // The middle of the liver, which goes on beyond the three slices, and the spine.
  EXPECT_GT(field->sample({-120, -40, -127.69}).mm, 10);
  EXPECT_LT(field->sample({-28, 77, -127.69}).mm, -10);
}

}  // namespace
}  // namespace palpate::io
