#include "testdata/write_flow.h"

#include <gtest/gtest.h>

#include <array>
#include <glm/geometric.hpp>

#include "io/fields/volume_fields.h"
#include "io/fresh_folder.h"
#include "io/load.h"

namespace palpate::testdata {
namespace {

namespace fs = std::filesystem;

class FlowFolder : public ::testing::Test {
 protected:
  io::Catalogue write(const FlowStudy& study) {
    write_flow_study(study, folder_);
    return io::find_series(std::array{folder_});
  }

  const io::FreshFolder scratch_ = io::temporary_folder();
  const fs::path folder_ = scratch_.path() / "flow";
};

FlowStudy small_study() {
  FlowStudy study;
  study.grid.size = {40, 36, 32};
  study.grid.spacing = {2.5, 2.5, 3};
  study.grid = rotated(study.grid, {1, 2, 3}, 30);
  study.flow.free_stream = {0.8, -0.3, 0.4};
  study.flow.half_width = 35;
  study.times = 3;
  return study;
}

io::Volume load_time(const io::Series& series, int time) {
  io::LoadOptions options;
  options.frame = time;
  return io::load(series, options);
}

TEST_F(FlowFolder, ThreeDirectionsComeBackAsTheVelocityTheyWereMadeOf) {
  const FlowStudy study = small_study();
  const io::Catalogue found = write(study);
  ASSERT_EQ(found.series.size(), 4U);
  for (const io::Series& series : found.series) EXPECT_EQ(series.frames_per_position, 3);
  ASSERT_EQ(found.velocity_fields.size(), 1U);
  const io::Series& field = found.velocity_fields[0];
  EXPECT_EQ(field.frames_per_position, 3);
  EXPECT_EQ(field.unit, "m/s");
  // One stored step along each of three perpendicular directions, half of it either way.
  const double step = 1e-2 * 1.2 * fastest_cm_per_s(study) / 2048;
  for (int time = 0; time < study.times; ++time) {
    FlowPastSphere now = study.flow;
    now.free_stream = free_stream_at(study, time);
    const FlowSource exact(now);
    const auto volume = std::make_shared<const io::Volume>(load_time(field, time));
    constexpr io::FieldSet wanted = io::FieldSet::vector | io::FieldSet::value;
    const io::VolumeFields fields(volume, wanted, 0, {.value = io::ValueMethod::trilinear});
    int inside = 0;
    for (int k = 0; k < 32; ++k) {
      for (int j = 0; j < 36; ++j) {
        for (int i = 0; i < 40; ++i) {
          const Vec3 at = volume->geometry.to_patient({i, j, k});
          const io::Sample truth = exact.sample(at, wanted);
          const io::Sample got = fields.sample(at, wanted);
          ASSERT_EQ(got.inside, truth.inside);
          ASSERT_LE(glm::length(got.vector - truth.vector), 0.5001 * step * std::sqrt(3.0));
          ASSERT_NEAR(got.value, glm::length(got.vector), 1e-6);
          inside += got.inside;
        }
      }
    }
    EXPECT_GT(inside, 10000);
  }
}

TEST_F(FlowFolder, AMissingDirectionMakesNoField) {
  FlowStudy study = small_study();
  study.times = 1;
  write(study);
  fs::remove_all(folder_ / "velocity_02");
  const io::Catalogue found = io::find_series(std::array{folder_});
  EXPECT_EQ(found.series.size(), 3U);
  EXPECT_TRUE(found.velocity_fields.empty());
}

TEST_F(FlowFolder, ASpeedAboveVencIsRefused) {
  FlowStudy study = small_study();
  study.venc_cm_per_s = 0.9 * fastest_cm_per_s(study);
  EXPECT_THROW(write_flow_study(study, folder_), std::invalid_argument);
  EXPECT_FALSE(fs::exists(folder_));
}

}  // namespace
}  // namespace palpate::testdata
