#include "modes/scene/boundary_names.h"

#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <random>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "modes/scene/tissue_colors.h"

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

TEST(BoundaryNames, of_air_in_a_ct_tell_every_site_where_it_is_met) {
  const auto name = [](double low, double high, const SiteCounts& sites) {
    const NamedPair pair{.low = low, .high = high, .sites = sites};
    return boundary_names(std::array{pair}, {.hounsfield = true, .range = 1000}).front();
  };
  // skin, lung, inner air, table, cloth, elsewhere
  EXPECT_EQ(name(-1000, 40, {900, 0, 0, 0, 0, 100}), "Skin");
  EXPECT_EQ(name(-1000, 40, {500, 300, 20, 100, 30, 0}), "Skin, lung surface, air inside the body and table");
  EXPECT_EQ(name(-850, 40, {0, 300, 0, 0, 0, 0}), "Lung surface");
  EXPECT_EQ(name(-1000, 40, {10000, 0, 9, 0, 0, 0}), "Skin") << "less than a thousandth is noise";
  EXPECT_EQ(name(-1000, 40, {10000, 0, 11, 0, 0, 0}), "Skin and air inside the body");
  EXPECT_EQ(name(-1000, 700, {500, 0, 20, 100, 0, 0}), "Bone at air and table");
  EXPECT_EQ(name(-1000, 200, {0, 0, 0, 100, 0, 0}), "Table");
  EXPECT_EQ(name(-1000, -850, {0, 100, 0, 0, 0, 0}), "Airways in the lung");
  EXPECT_EQ(name(-1000, -850, {0, 0, 0, 0, 100, 0}), "Foam or cloth");
  EXPECT_EQ(name(40, 700, {500, 0, 0, 0, 0, 0}), "Bone") << "not of air";
}

/// A mat that lies on the table is of the table, and one that lies elsewhere is cloth: both count, together.
TEST(BoundaryNames, of_a_light_thing_are_foam_or_cloth_wherever_it_lies) {
  for (const std::uint64_t cloth : {0U, 6U, 11U, 5000U}) {
    for (const std::uint64_t table : {0U, 6U, 11U, 5000U}) {
      const bool is_told = 1000 * (cloth + table) > 10000 + cloth + table;
      const NamedPair of_lung{.low = -1000, .high = -850, .sites = {0, 10000, 0, table, cloth, 0}};
      const NamedPair of_nothing{.low = -1000, .high = -850, .sites = {0, 0, 0, table, cloth, 10000}};
      const NamingOptions options{.hounsfield = true, .range = 1000};
      EXPECT_EQ(boundary_names(std::array{of_lung}, options).front(),
                is_told ? "Airways in the lung and foam or cloth" : "Airways in the lung")
          << cloth << ' ' << table;
      EXPECT_EQ(boundary_names(std::array{of_nothing}, options).front(), is_told ? "Foam or cloth" : "Lung or foam")
          << cloth << ' ' << table;
    }
  }
}

/// Every tissue that a name can tell has a color of its own.
TEST(BoundaryNames, have_the_colors_of_the_tissues_that_they_tell) {
  const std::pair<std::string_view, TissueKind> names[] = {{"Skin", TissueKind::skin},
                                                           {"Skin?", TissueKind::skin},
                                                           {"Skin, lung surface and table", TissueKind::skin},
                                                           {"Scalp and brain surface?", TissueKind::skin},
                                                           {"Scalp fat or CSF?", TissueKind::skin},
                                                           {"Bone", TissueKind::bone},
                                                           {"Bone, 717 HU from 40", TissueKind::bone},
                                                           {"Bone at air and table", TissueKind::bone},
                                                           {"Dense bone", TissueKind::bone},
                                                           {"Soft tissue", TissueKind::soft_tissue},
                                                           {"Gray and white matter?", TissueKind::soft_tissue},
                                                           {"Tissue 2 to 3", TissueKind::soft_tissue},
                                                           {"Wall in soft tissue", TissueKind::soft_tissue},
                                                           {"Lung surface", TissueKind::lung},
                                                           {"Lung or foam", TissueKind::lung},
                                                           {"Airways in the lung", TissueKind::lung},
                                                           {"Air inside the body", TissueKind::inner_air},
                                                           {"Metal", TissueKind::metal},
                                                           {"Metal, 3000 HU", TissueKind::metal},
                                                           {"Table", TissueKind::table},
                                                           {"Foam or cloth", TissueKind::table}};
  for (const auto& [name, kind] : names) {
    EXPECT_EQ(kind_of(name), kind) << name;
    EXPECT_EQ(kind_of(way_back_name(std::string(name))), kind) << name;
  }
  const TissueKind kinds[] = {TissueKind::skin,      TissueKind::bone,  TissueKind::soft_tissue, TissueKind::lung,
                              TissueKind::inner_air, TissueKind::metal, TissueKind::vessel,      TissueKind::table};
  std::set<std::string_view> colors;
  for (const TissueKind kind : kinds) EXPECT_TRUE(colors.insert(color_of(kind)).second) << color_of(kind);
}

/// Where there is bone, all air of the body is one: a sinus is neither skin nor lung.
TEST(BoundaryNames, of_bone_at_air_are_the_same_at_every_site_of_the_body) {
  for (unsigned met = 1; met < 8; ++met) {
    NamedPair pair{.low = -1000, .high = 700};
    for (unsigned site = 0; site < 3; ++site) pair.sites[site] = (met >> site & 1U) * (100 + site);
    EXPECT_EQ(boundary_names(std::array{pair}, {.hounsfield = true, .range = 1000}).front(), "Bone at air") << met;
  }
  for (const Site site : {Site::skin, Site::lung, Site::inner_air}) {
    EXPECT_EQ(name_at("Bone at air and table", site), "Bone at air");
  }
}

/// Of one in a thousand edges it is not known whether it is noise; of more it is.
TEST(BoundaryNames, tell_a_site_of_more_than_a_thousandth_of_the_edges) {
  std::mt19937_64 random(3);
  std::uniform_int_distribution<std::uint64_t> few(1, 50);
  for (int n = 0; n < 200; ++n) {
    const std::uint64_t of_air = few(random);
    // All edges are 1000 times as many, or one fewer.
    for (const bool is_noise : {true, false}) {
      const NamedPair pair{.low = -1000, .high = 40, .sites = {999 * of_air - (is_noise ? 0 : 1), 0, of_air}};
      EXPECT_EQ(boundary_names(std::array{pair}, {.hounsfield = true, .range = 1000}).front(),
                is_noise ? "Skin" : "Skin and air inside the body")
          << of_air;
    }
  }
}

TEST(BoundaryNames, are_at_one_site_that_sites) {
  const std::string all = "Skin, lung surface and table";
  EXPECT_EQ(name_at(all, Site::skin), "Skin");
  EXPECT_EQ(name_at(all, Site::lung), "Lung surface");
  EXPECT_EQ(name_at(all, Site::table), "Table");
  EXPECT_EQ(name_at(all, Site::inner_air), "Air inside the body");
  EXPECT_EQ(name_at(all, Site::elsewhere), all);
  EXPECT_EQ(name_at("skin and lung surface", Site::lung), "lung surface");
  EXPECT_EQ(name_at("skin", Site::table), "table");
  EXPECT_EQ(name_at("Skin, from inside", Site::lung), "Lung surface, from inside");
  EXPECT_EQ(name_at("Bone at air and table", Site::inner_air), "Bone at air");
  EXPECT_EQ(name_at("Bone at air and table", Site::table), "Table");
  for (const std::string& name :
       {std::string("Bone"), std::string("My skin"), std::string("Skin and liver"), std::string()}) {
    for (const Site site : {Site::skin, Site::table}) EXPECT_EQ(name_at(name, site), name);
  }
}

TEST(BoundaryNames, of_a_head_are_questions_about_the_brain) {
  const std::vector<NamedPair> boundaries{{300, 800}, {10, 300}, {10, 800}};
  EXPECT_EQ(boundary_names(boundaries, {.is_head = true, .range = 1000}),
            (Names{"Gray and white matter?", "Scalp and brain surface?", "Scalp fat or CSF?"}));
}

TEST(BoundaryNames, tell_the_way_back) {
  EXPECT_EQ(way_back_name("Skin"), "Skin, from inside");
}

}  // namespace
}  // namespace palpate::modes
