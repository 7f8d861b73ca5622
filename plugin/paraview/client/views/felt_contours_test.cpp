#include "plugin/paraview/client/views/felt_contours.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>
#include <memory>

#include "io/fields/volume_fields.h"
#include "modes/scene/scene_json.h"
#include "plugin/session/prepared_scene.h"
#include "testdata/phantom.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

/// Another scan is chosen while the lines of the one before are sought: the views are not closed before the work ends.
TEST(FeltContours, EndAtTheNextRowOrPieceWhereNobodyWantsThem) {
  const auto volume = std::make_shared<const io::Volume>(
      testdata::scan(testdata::make_sphere(20), testdata::make_geometry({.size = glm::ivec3(60)})));
  const modes::Scene scene = modes::load_scene("ct-skin-and-bone");
  const auto plan = plan_for(scene, *volume, glm::dvec3(0.1));
  io::FieldOptions options;
  options.brick_bytes = 0;
  options.background = false;
  const io::VolumeFields source(volume, scan_fields(*plan) | io::FieldSet::value,
                                io::default_gradient_scale_mm(volume->geometry), options);
  const SlicePoints points{.corner = {-28, -28, 0}, .columns = 57, .rows = 57};
  int all = 0;
  const auto contours = felt_contours(scene, *plan, source, points, [&] { return ++all > 0; });
  ASSERT_EQ(contours.size(), 1U) << "the skin";
  ASSERT_GT(contours[0].pieces.size(), 60U);
  for (const auto& piece : contours[0].pieces) EXPECT_NEAR(glm::length(piece[0]), 20, 0.5);
  EXPECT_GE(all, 57 + 60);
  for (const int wanted : {0, 30, 57, all - 1}) {
    int asked = 0;
    EXPECT_THROW(felt_contours(scene, *plan, source, points, [&] { return ++asked <= wanted; }), io::Cancelled);
    EXPECT_EQ(asked, wanted + 1) << "it is asked no more";
  }
}

}  // namespace
}  // namespace palpate::plugin
