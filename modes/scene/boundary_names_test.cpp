#include "modes/scene/boundary_names.h"

#include <gtest/gtest.h>

namespace palpate::modes {
namespace {

using Names = std::vector<std::string>;

TEST(BoundaryNames, are_a_clinicians_words_for_a_ct) {
  const std::vector<NamedPair> head{{-1000, 40}, {40, 900}, {-1000, 900}, {-100, 50}};
  EXPECT_EQ(boundary_names(head, {.hounsfield = true, .range = 1000}),
            (Names{"Skin", "Bone", "Bone at air", "Soft tissue"}));
  const std::vector<NamedPair> chest{{-1000, -850}, {-850, 40}, {-1000, -100}, {900, 3000}, {200, 1200}};
  EXPECT_EQ(boundary_names(chest, {.hounsfield = true, .range = 1000}),
            (Names{"Lung or foam", "Lung surface", "Skin", "Metal", "Dense bone"}));
  // A rib that touches the lung has no soft tissue in between either.
  const std::vector<NamedPair> rib{{-850, 700}, {40, 700}};
  EXPECT_EQ(boundary_names(rib, {.hounsfield = true, .range = 1000}), (Names{"Bone at air", "Bone"}));
}

TEST(BoundaryNames, that_would_be_shared_tell_the_denser_tissue_and_then_the_other) {
  const std::vector<NamedPair> boundaries{{40, 338}, {40, 717}, {-100, 717}};
  EXPECT_EQ(boundary_names(boundaries, {.hounsfield = true, .range = 1000}),
            (Names{"Bone, 338 HU", "Bone, 717 HU from 40", "Bone, 717 HU from -100"}));
}

TEST(BoundaryNames, without_hu_are_questions_or_ranks) {
  const std::vector<NamedPair> boundaries{{300, 800}, {10, 300}, {10, 800}};
  EXPECT_EQ(boundary_names(boundaries, {.range = 1000}), (Names{"Tissue 2 to 3", "Skin?", "Tissue 1 to 3"}));
  EXPECT_TRUE(boundary_names({}, {.range = 1000}).empty());
}

TEST(BoundaryNames, of_walls_within_a_tissue_tell_which) {
  const std::vector<NamedPair> ct{
      {-850, 40}, {-850, -750, "lung or foam"}, {-90, 50, "soft tissue"}, {-2, 178, "soft tissue"}};
  EXPECT_EQ(boundary_names(ct, {.hounsfield = true, .range = 1000}),
            (Names{"Lung surface", "Wall in lung or foam", "Soft tissue", "Wall in soft tissue"}));
  const std::vector<NamedPair> mr{{10, 300}, {300, 800}, {250, 340, "tissue 2 of 3"}};
  EXPECT_EQ(boundary_names(mr, {.range = 1000}),
            (Names{"Skin?", "Tissue 2 to 3", "Wall in tissue 2 of 3, 250 to 340"}));
}

TEST(BoundaryNames, tell_the_way_back) {
  EXPECT_EQ(way_back_name("Skin"), "Skin, from inside");
}

}  // namespace
}  // namespace palpate::modes
