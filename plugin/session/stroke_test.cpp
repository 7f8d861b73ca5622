// What a stroke tells of a boundary's strength: all of it at a thick wall, less at a plate thinner than the gradient's
// scale.
#include "plugin/session/stroke.h"

#include <gtest/gtest.h>

#include <array>
#include <memory>

#include "modes/scene/scene_json.h"
#include "plugin/session/scan.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

/// The first contact with bone on the way along -z into a wall of bone that is so thick.
Contact contact_with_bone(double thickness_mm) {
  const std::array layers{testdata::Layer{-10, testdata::soft_tissue_hu}, testdata::Layer{0, testdata::bone_hu},
                          testdata::Layer{thickness_mm, testdata::soft_tissue_hu}};
  const testdata::Phantom phantom = testdata::make_slab({0, 0, -1}, layers);
  const auto volume = std::make_shared<io::Volume>(
      testdata::scan(phantom, testdata::make_geometry({.size = glm::ivec3(40), .spacing = glm::dvec3(1)})));
  const modes::Scene scene = modes::load_scene("ct-bone");
  const PreparedScene felt = prepare(scene, volume, glm::dvec3(0.1));
  const auto stroke = run_stroke(*felt.plan, *felt.source, {0.2, 0.3, 6}, {0.2, 0.3, -4}, 20);
  auto contacts = contacts_of(stroke, *felt.plan, met_n);
  add_strengths(contacts, stroke, *felt.plan, *felt.source);
  EXPECT_FALSE(contacts.empty());
  return contacts.empty() ? Contact{} : contacts.front();
}

TEST(Stroke, AThickWallTakesItsFullStrengthAndAThinPlateLessWhichIsSaid) {
  const Contact thick = contact_with_bone(12);
  EXPECT_GT(thick.strength_n, 0.95 * thick.full_strength_n);
  EXPECT_EQ(strength_to_text(thick), "");
  const Contact thin = contact_with_bone(1.0);
  EXPECT_LT(thin.strength_n, 0.75 * thin.full_strength_n);
  EXPECT_GT(thin.strength_n, 0);
  EXPECT_NE(strength_to_text(thin).find("thin or faint there"), std::string::npos);
  // The wall yields where the pull exceeds what it takes and the scene's friction of at most 0.1 N.
  EXPECT_GT(thin.peak_n, 0.95 * thin.strength_n);
  EXPECT_LT(thin.peak_n, thin.strength_n + 0.1 + 0.001);
}

}  // namespace
}  // namespace palpate::plugin
