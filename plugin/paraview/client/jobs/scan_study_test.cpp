#include "plugin/paraview/client/jobs/scan_study.h"

#include <gtest/gtest.h>

#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

io::Volume ball() {
  return testdata::scan(testdata::make_sphere(15), testdata::make_geometry({.size = glm::ivec3(40)}));
}

ScanStudy study_of(io::Volume volume) {
  return study_scan(std::make_shared<const io::Volume>(std::move(volume)), [](double) { return true; });
}

TEST(ScanStudy, SuggestsWhatItFound) {
  const ScanStudy study = study_of(ball());
  ASSERT_TRUE(study.suggested);
  EXPECT_FALSE(study.suggested->modes.empty());
  EXPECT_NE(study.sites, nullptr);
  EXPECT_EQ(std::accumulate(study.values.counts.begin(), study.values.counts.end(), 0.0), 40 * 40 * 40);
}

TEST(ScanStudy, SuggestsNothingIfNothingIsFoundAndForAFlow) {
  io::Volume even = ball();
  even.voxels = std::vector<float>(40 * 40 * 40, 7);
  EXPECT_FALSE(study_of(even).suggested);
  io::Volume flow = ball();
  flow.vectors = std::make_shared<const io::VectorComponents>();
  EXPECT_FALSE(study_of(flow).suggested) << "the steps in a flow's speed are not boundaries";
}

}  // namespace
}  // namespace palpate::plugin
