/// What is prepared from what was there before is the same as what is prepared anew, to the last bit, whatever was
/// edited; and what the edit left alone is used again.

#include <gtest/gtest.h>

#include <filesystem>
#include <functional>
#include <glm/geometric.hpp>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "io/fields/filtered.h"
#include "io/structures/structured_fields.h"
#include "modes/scene/scene_json.h"
#include "plugin/session/prepared_scene.h"
#include "plugin/session/scene_fit.h"
#include "plugin/testing/opened_files.h"
#include "plugin/testing/registered_study.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

using VolumePointer = std::shared_ptr<const io::Volume>;

/// Oblique, tilted, uneven and not square.
VolumePointer odd_ball(double radius_mm) {
  testdata::Grid grid;
  grid.size = {15, 13, 11};
  grid.spacing = {1.2, 1.7, 2.3};
  grid.center = {4, -3, 9};
  grid.tilt_degrees = 7;
  grid.uneven_mm = 0.3;
  const testdata::Phantom ball{.background = testdata::air_hu,
                               .bodies = {{testdata::Ball{grid.center, radius_mm}, testdata::soft_tissue_hu}}};
  auto volume = testdata::scan(
      ball, testdata::make_geometry(testdata::rotated(grid, glm::normalize(glm::dvec3(2, 1, -1)), 25)), {.noise = 20});
  volume.frame_of_reference_uid = "1.1";
  return std::make_shared<const io::Volume>(std::move(volume));
}

const glm::dvec3 half_extent_m(0.05, 0.04, 0.06);

void expect_the_same(const PreparedScene& again, const PreparedScene& anew, const std::string& what) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> place(-14, 14);
  ASSERT_EQ(again.plan->fields, anew.plan->fields) << what;
  EXPECT_EQ(again.plan->slices, anew.plan->slices) << what;
  EXPECT_EQ(again.source->available(), anew.source->available()) << what;
  EXPECT_EQ(again.volume->voxels, anew.volume->voxels) << what;
  int inside = 0;
  for (int n = 0; n < 150; ++n) {
    const glm::dvec3 at(4 + place(random), -3 + place(random), 9 + place(random));
    const io::Sample one = again.source->sample(at, again.plan->fields),
                     other = anew.source->sample(at, anew.plan->fields);
    ASSERT_EQ(one.inside, other.inside);
    ASSERT_EQ(one.value, other.value) << what;
    ASSERT_EQ(one.gradient, other.gradient) << what;
    ASSERT_EQ(one.tube, other.tube) << what;
    ASSERT_EQ(one.low, other.low) << what;
    for (std::size_t of = 0; of < again.structures.size(); ++of) {
      ASSERT_EQ(one.distance[of].mm, other.distance[of].mm) << what;
    }
    inside += one.inside ? 1 : 0;
  }
  EXPECT_GT(inside, 30);
}

struct Edit {
  const char* what;
  std::function<void(modes::Scene&)> edit;
  bool keeps_source, keeps_volume;
};

TEST(PreparedAgain, IsWhatIsPreparedAnewAndReusesWhatIsTheSame) {
  const modes::Scene scene = modes::scene_from_json(
      R"({"version": 1, "modes": [{"type": "surface", "strength_n": {"of": "gradient_per_mm", "nodes": [[20, 0], [90, 1]]}}]})",
      "test");
  const std::vector<Edit> edits{
      {"nothing", [](modes::Scene&) {}, true, true},
      {"a strength",
       [](modes::Scene& s) {
         s.modes[0].strength_n = modes::TransferFunction({{10, 0}, {50, 0.9}});
       },
       true, true},
      {"the stiffness", [](modes::Scene& s) { s.stiffness_n_per_m = 500; }, true, true},
      {"the scale", [](modes::Scene& s) { s.gradient_scale_mm = 2.5; }, false, true},
      {"the value", [](modes::Scene& s) { s.sampling.value = io::ValueMethod::trilinear; }, false, true},
      {"the gradient", [](modes::Scene& s) { s.sampling.gradient = io::GradientMethod::central_differences; }, false,
       true},
      {"another field",
       [](modes::Scene& s) {
         modes::Gate gate;
         gate.of = modes::Datum::low;
         gate.factor = modes::TransferFunction({{-900, 0}, {0, 1}});
         s.modes[0].gates = {gate};
       },
       false, true},
      {"the reach", [](modes::Scene& s) { s.workspace.center_mm = glm::dvec3(4, -3, 70); }, false, true},
      {"the filter", [](modes::Scene& s) { s.filter.type = io::find_filter_type("median"); }, false, false}};
  const VolumePointer volume = odd_ball(9), other = odd_ball(6);
  const PreparedScene first = prepare(scene, volume, half_extent_m);
  for (const Edit& edit : edits) {
    modes::Scene edited = scene;
    edit.edit(edited);
    const PreparedScene anew = prepare(edited, volume, half_extent_m);
    const PreparedScene again = prepare(edited, volume, half_extent_m, {first, scene});
    expect_the_same(again, anew, edit.what);
    EXPECT_EQ(again.source == first.source, edit.keeps_source) << edit.what;
    EXPECT_EQ(again.volume == first.volume, edit.keeps_volume) << edit.what;
    // And back.
    const PreparedScene back = prepare(scene, volume, half_extent_m, {anew, edited});
    expect_the_same(back, first, edit.what);
    EXPECT_EQ(back.source == anew.source, edit.keeps_source) << edit.what;
    EXPECT_EQ(back.volume == anew.volume, edit.keeps_volume) << edit.what;
    // The same scene on another scan has nothing in common.
    const PreparedScene elsewhere = prepare(edited, other, half_extent_m, {first, scene});
    expect_the_same(elsewhere, prepare(edited, other, half_extent_m), edit.what);
    EXPECT_NE(elsewhere.source, first.source) << edit.what;
  }
}

/// A volume that was filtered ahead is taken where the scene has that very filter, and is filtered anew where not.
TEST(PreparedAgain, TakesAVolumeThatWasFilteredAhead) {
  modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  scene.filter.type = io::find_filter_type("median");
  const VolumePointer volume = odd_ball(9);
  Prepared ahead;
  ahead.felt.volume = io::filtered(volume, scene.filter);
  EXPECT_EQ(prepare(scene, volume, half_extent_m, ahead).volume, ahead.felt.volume);
  scene.filter.width = 5;
  EXPECT_NE(prepare(scene, volume, half_extent_m, ahead).volume, ahead.felt.volume);
  scene.filter = {};
  EXPECT_EQ(prepare(scene, volume, half_extent_m, ahead).volume, volume);
}

/// Of a scan with structures the fields of the scan itself stay while the distances change, and a structure's distance
/// stays while it is the same structure.
TEST(PreparedAgain, KeepsTheScanWhileItsStructuresChange) {
  const io::internal::TestFolder folder;
  testing::write_contours(folder / "rt.dcm", "1.1", "7", "Doe^Jane");
  const VolumePointer volume = odd_ball(9);
  const modes::Scene scene = testing::scene_of(folder / "rt.dcm");
  const PreparedScene first = prepare(scene, volume, half_extent_m);
  const auto scan_of = [](const PreparedScene& felt) {
    return std::dynamic_pointer_cast<const io::StructuredFields>(felt.source)->scan();
  };
  ASSERT_EQ(first.structures.size(), 1U);
  EXPECT_EQ(prepare(scene, volume, half_extent_m, {first, scene}).source, first.source);
  modes::Scene wider = scene;
  wider.modes[0].level_mm = -9;
  const PreparedScene again = prepare(wider, volume, half_extent_m, {first, scene});
  EXPECT_NE(again.source, first.source);
  EXPECT_NE(again.structures[0].distance, first.structures[0].distance);
  EXPECT_EQ(scan_of(again), scan_of(first));
  expect_the_same(again, prepare(wider, volume, half_extent_m), "another reach");
  modes::Scene sharper = scene;
  sharper.gradient_scale_mm = 3;
  const PreparedScene sharp = prepare(sharper, volume, half_extent_m, {first, scene});
  EXPECT_NE(scan_of(sharp), scan_of(first));
  EXPECT_EQ(sharp.structures[0].distance, first.structures[0].distance);
  expect_the_same(sharp, prepare(sharper, volume, half_extent_m), "another scale");
  EXPECT_EQ(scan_fields(*first.plan) & io::FieldSet::distance, io::FieldSet::none);
  EXPECT_EQ(scan_fields(*first.plan) | io::FieldSet::distance, first.plan->fields);
  EXPECT_TRUE(registered_of(first).empty());
}

/// The next frame of a series: its structures are those that were read, but for what edits have read of the frame.
TEST(PreparedAgain, KeepsStructuresOnTheNextFrameAndReadsNoFile) {
  const io::internal::TestFolder folder;
  testing::write_contours(folder / "rt.dcm", "1.1", "7", "Doe^Jane");
  const VolumePointer volume = odd_ball(9);
  const auto other = [&](const std::function<void(io::Volume&)>& change) {
    io::Volume changed = *odd_ball(6);
    change(changed);
    return std::make_shared<const io::Volume>(std::move(changed));
  };
  modes::Scene scene = testing::scene_of(folder / "rt.dcm");
  scene.structures[0].edits = {io::AddEdit{{.path_mm = {{10, 0, 9}}, .radius_mm = 4}},
                               io::ScanEdgeEdit{.center_mm = {10, 0, 9}, .radius_mm = 8, .most_mm = 4},
                               io::RemoveEdit{{.path_mm = {{-10, 0, 9}}, .radius_mm = 3}}};
  const PreparedScene first = prepare(scene, volume, half_extent_m);
  ASSERT_EQ(first.structures.size(), 1U);
  testing::OpenedFiles opened({folder / ""});
  const VolumePointer frame = other([](io::Volume&) {});
  const PreparedScene next = prepare(scene, frame, half_extent_m, {first, scene});
  EXPECT_TRUE(opened.count().empty());
  EXPECT_EQ(next.structures[0].before_edits[1], first.structures[0].before_edits[1]);
  EXPECT_NE(next.structures[0].distance, first.structures[0].distance) << "an edit reads the frame";
  expect_the_same(next, prepare(scene, frame, half_extent_m), "the next frame");
  const std::pair<const char*, std::function<void(io::Volume&)>> others[] = {
      {"a frame of reference", [](io::Volume& v) { v.frame_of_reference_uid = ""; }},
      {"a patient", [](io::Volume& v) { v.patient_id = "7"; }},
      {"a name", [](io::Volume& v) { v.patient_name = "Doe^Jane"; }},
      {"a place", [](io::Volume& v) { v.geometry.slice_positions.front().x += 1e-3; }}};
  for (const auto& [what, change] : others) {
    const VolumePointer elsewhere = other(change);
    opened.count();
    expect_the_same(prepare(scene, elsewhere, half_extent_m, {first, scene}), prepare(scene, elsewhere, half_extent_m),
                    what);
    EXPECT_FALSE(opened.count().empty()) << what;
  }
}

/// A scene that reads nothing but its structures can be felt on any scan: distances are no field of the scan's.
TEST(SceneFit, OfStructuresAloneIsFeltOnAnyScan) {
  modes::Scene scene = testing::scene_of("/a/rt.dcm");
  EXPECT_EQ(static_cast<std::string>(why_not_felt(scene, *odd_ball(9))), "");
  modes::Mode follow;
  follow.type = "follow";
  follow.strength_n = modes::TransferFunction(0.2);
  scene.modes = {follow};
  scene.name = "stream";
  EXPECT_EQ(static_cast<std::string>(why_not_felt(scene, *odd_ball(9))),
            "the scene \"stream\" cannot be felt on this scan, which has no vector field: open a velocity field (phase "
            "contrast), or choose another scene");
  modes::Mode unknown;
  unknown.type = "no such mode";
  scene.modes = {unknown};
  EXPECT_EQ(static_cast<std::string>(why_not_felt(scene, *odd_ball(9))), "") << "that is for others to say";
}

}  // namespace
}  // namespace palpate::plugin
