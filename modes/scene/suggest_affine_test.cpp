// A suggestion belongs to a scan and not to its unit: any change value -> factor * value + offset gives the same scene,
// in the new values. Truth is the suggestion of the scan as it was.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "modes/scene/scene_json.h"
#include "modes/scene/suggest.h"
#include "testdata/scan.h"

namespace palpate::modes {
namespace {

using testdata::air_hu;
using testdata::HalfSpace;

/// A scan without a unit: skin and bone, or plates that are faint walls within a tissue.
io::Volume affine_scan(bool with_walls, double noise) {
  testdata::Phantom phantom = testdata::make_sphere(24);
  phantom.bodies.push_back(testdata::make_sphere(16, testdata::bone_hu).bodies.front());
  if (with_walls) {
    phantom = {.background = air_hu,
               .bodies = {{HalfSpace{{0, 0, 1}, 20}, 40},
                          {HalfSpace{{0, 0, 1}, 8}, 110},
                          {HalfSpace{{0, 0, 1}, 5}, 40},
                          {HalfSpace{{0, 0, 1}, -6}, 115},
                          {HalfSpace{{0, 0, 1}, -9}, 45}}};
  }
  io::Volume volume = testdata::scan(phantom, testdata::make_geometry({.size = glm::ivec3(56)}), {.noise = noise});
  volume.unit.clear();
  volume.modality = "MR";
  return volume;
}

struct Affine {
  double factor, offset;
  double of(double value) const { return factor * value + offset; }
};

std::shared_ptr<const io::Volume> rescaled(io::Volume volume, const Affine& change) {
  volume.slope *= change.factor;
  volume.intercept = change.of(volume.intercept);
  return std::make_shared<const io::Volume>(std::move(volume));
}

constexpr double phantom_range = 3000;  // of the phantoms, about

void expect_sound_scene(const Suggestion& found) {
  EXPECT_NO_THROW(validate(found.scene));
  EXPECT_EQ(to_json(scene_from_json(to_json(found.scene), "suggested")), to_json(found.scene));
  ASSERT_EQ(found.typical.size(), found.scene.tissues.size());
  std::set<std::string> names;
  for (const Tissue& tissue : found.scene.tissues) EXPECT_TRUE(names.insert(tissue.name).second) << tissue.name;
  for (const FoundBoundary& boundary : found.boundaries) {
    ASSERT_LT(boundary.low, found.typical.size());
    ASSERT_LT(boundary.high, found.typical.size());
    EXPECT_LT(found.typical[boundary.low], found.typical[boundary.high]);
    EXPECT_LT(boundary.mode, found.scene.modes.size());
    EXPECT_LT(boundary.way_back, found.scene.modes.size());
  }
}

void expect_same_nodes(const TransferFunction& now, const TransferFunction& was, bool of_gradients, double near,
                       const Affine& change) {
  ASSERT_EQ(now.nodes().size(), was.nodes().size());
  for (std::size_t n = 0; n < was.nodes().size(); ++n) {
    EXPECT_EQ(now.nodes()[n].value, was.nodes()[n].value);
    const double at = was.nodes()[n].at;
    EXPECT_NEAR(now.nodes()[n].at, of_gradients ? change.factor * at : change.of(at), near);
  }
}

void expect_same_scene(const Suggestion& found, const Suggestion& before, const Affine& change) {
  const double near = 2e-3 * phantom_range * change.factor;
  ASSERT_EQ(found.scene.tissues.size(), before.scene.tissues.size());
  for (std::size_t t = 0; t < before.typical.size(); ++t) {
    EXPECT_NEAR(found.typical[t], change.of(before.typical[t]), near);
    for (const auto end : {&Tissue::low, &Tissue::high}) {
      const double was = before.scene.tissues[t].*end;
      if (std::isfinite(was)) {
        EXPECT_NEAR(found.scene.tissues[t].*end, change.of(was), near);
      } else {
        EXPECT_EQ(found.scene.tissues[t].*end, was);
      }
    }
    EXPECT_NEAR(found.scene.tissues[t].softness, change.factor * before.scene.tissues[t].softness, near);
  }
  ASSERT_EQ(found.boundaries.size(), before.boundaries.size());
  for (std::size_t b = 0; b < before.boundaries.size(); ++b) {
    EXPECT_EQ(found.boundaries[b].low, before.boundaries[b].low);
    EXPECT_EQ(found.boundaries[b].high, before.boundaries[b].high);
    EXPECT_NEAR(found.boundaries[b].middle, change.of(before.boundaries[b].middle), near);
  }
  ASSERT_EQ(found.scene.modes.size(), before.scene.modes.size());
  for (std::size_t m = 0; m < before.scene.modes.size(); ++m) {
    const Mode &now = found.scene.modes[m], &was = before.scene.modes[m];
    ASSERT_EQ(now.type, was.type);
    ASSERT_EQ(now.gates.size(), was.gates.size());
    SCOPED_TRACE(now.name);
    EXPECT_EQ(now.enabled, was.enabled);
    expect_same_nodes(now.strength_n, was.strength_n, was.strength_of == Datum::gradient_magnitude, near, change);
    for (std::size_t g = 0; g < was.gates.size(); ++g) {
      ASSERT_EQ(now.gates[g].of, was.gates[g].of);
      expect_same_nodes(now.gates[g].factor, was.gates[g].factor, was.gates[g].of == Datum::gradient_magnitude, near,
                        change);
    }
  }
}

TEST(SuggestAffine, AnyChangeOfTheUnitGivesTheSameSceneInTheNewValues) {
  for (const bool with_walls : {false, true}) {
    const io::Volume volume = affine_scan(with_walls, with_walls ? 2 : 20);
    const Suggestion before = suggest(std::make_shared<const io::Volume>(volume));
    expect_sound_scene(before);
    ASSERT_GE(before.boundaries.size(), 2U);
    for (const double factor : {1e-9, 1e-5, 1.0 / 3000, 0.01, 1.0, 7.3, 1e6}) {
      for (const double offset_of_ranges : {0.0, 1.0, -20.0, 1000.0}) {
        const Affine change{factor, factor * phantom_range * offset_of_ranges};
        SCOPED_TRACE(::testing::Message()
                     << (with_walls ? "walls" : "head") << ": " << factor << " x + " << change.offset);
        const Suggestion found = suggest(rescaled(volume, change));
        expect_sound_scene(found);
        expect_same_scene(found, before, change);
      }
    }
  }
}

/// Two plates within one tissue, a brighter and a darker one: each side of each has a name of its own.
io::Volume scan_of_plates() {
  io::Volume volume = affine_scan(true, 2);
  const testdata::Phantom phantom{.background = air_hu,
                                  .bodies = {{HalfSpace{{0, 0, 1}, 20}, 40},
                                             {HalfSpace{{0, 0, 1}, 8}, 95},
                                             {HalfSpace{{0, 0, 1}, 5}, 40},
                                             {HalfSpace{{0, 0, 1}, -6}, -15},
                                             {HalfSpace{{0, 0, 1}, -9}, 40}}};
  volume.voxels = testdata::scan(phantom, volume.geometry, {.noise = 2}).voxels;
  return volume;
}

TEST(SuggestAffine, NamesDifferInAnyUnit) {
  const io::Volume volume = scan_of_plates();
  const Suggestion before = suggest(std::make_shared<const io::Volume>(volume));
  const auto parts = [](const Suggestion& of) {
    return std::ranges::count_if(of.scene.tissues,
                                 [](const Tissue& tissue) { return tissue.name.find(" part (") != std::string::npos; });
  };
  ASSERT_EQ(parts(before), 4);
  for (const double factor : {1e-9, 1e-5, 1.0 / 3000, 0.01, 1e6}) {
    for (const double offset_of_ranges : {0.0, -20.0}) {
      const Affine change{factor, factor * phantom_range * offset_of_ranges};
      SCOPED_TRACE(::testing::Message() << factor << " x + " << change.offset);
      const Suggestion found = suggest(rescaled(volume, change));
      expect_sound_scene(found);
      expect_same_scene(found, before, change);
      EXPECT_EQ(parts(found), 4);
    }
  }
}

/// Where floats cannot tell the values apart any more, what is suggested is poor; it is a scene all the same.
TEST(SuggestAffine, SlopesAndOffsetsOfAnySizeGiveAScene) {
  const io::Volume volume = affine_scan(true, 2);
  for (const double factor : {1e-300, 1e-30, 1e-3, 1e3, 1e12, 1e30, 1e300, 1e306}) {
    for (const double offset : {0.0, 1e6, -1e12, 1e300}) {
      SCOPED_TRACE(::testing::Message() << factor << " x + " << offset);
      expect_sound_scene(suggest(rescaled(volume, {factor, offset})));
    }
  }
}

}  // namespace
}  // namespace palpate::modes
