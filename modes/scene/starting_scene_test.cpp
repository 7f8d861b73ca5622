#include "modes/scene/starting_scene.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "modes/scene/scene_json.h"

namespace palpate::modes {
namespace {

std::string offered(const std::string& modality, const std::string& body_part, const std::string& description) {
  io::Series series;
  series.modality = modality;
  series.details.body_part = body_part;
  series.description = description;
  const std::string name = starting_scene(series);
  EXPECT_FALSE(load_scene(name).modes.empty());
  return name;
}

TEST(StartingScene, goes_by_the_part_of_the_body) {
  EXPECT_EQ(offered("CT", "CHEST", ""), "ct-chest");
  EXPECT_EQ(offered("CT", "ABDOMENPELVIS", ""), "ct-abdomen");
  EXPECT_EQ(offered("CT", "LSPINE", ""), "ct-spine");
  EXPECT_EQ(offered("CT", "HEAD", ""), "ct-skin-and-bone");
  EXPECT_EQ(offered("MR", "BRAIN", ""), "mr-brain");
}

TEST(StartingScene, goes_by_the_description_where_the_part_says_nothing) {
  EXPECT_EQ(offered("CT", "PARTIALBODY", "3mm_Thorax/lung kernel"), "ct-chest");
  EXPECT_EQ(offered("CT", "", "LWS 1.0 B60s"), "ct-spine");
  EXPECT_EQ(offered("CT", "", "ABDOMEN THORAX"), "ct-abdomen") << "the first of two";
  EXPECT_EQ(offered("CT", "HEAD", "abdomen"), "ct-skin-and-bone") << "BodyPartExamined goes first";
}

/// The words of a description say the same in German and in English.
TEST(StartingScene, goes_by_the_part_before_the_description) {
  io::Volume volume;
  volume.modality = "CT";
  volume.body_part = "HEAD";
  volume.description = "Chest 1.0";
  EXPECT_EQ(part_of_body(volume), "HEAD");
  EXPECT_TRUE(is_of_head(volume));
  std::swap(volume.body_part, volume.description);
  EXPECT_NE(part_of_body(volume), "HEAD");
  EXPECT_FALSE(is_of_head(volume));
}

TEST(StartingScene, is_that_of_a_flow_for_a_volume_of_vectors_alone) {
  for (const char* const modality : {"CT", "MR"}) {
    io::Volume volume;
    volume.modality = modality;
    EXPECT_EQ(starting_scene(volume), offered(modality, "", ""));
    volume.vectors = std::make_shared<const io::VectorComponents>();
    EXPECT_EQ(starting_scene(volume), "flow");
  }
}

TEST(StartingScene, is_the_same_for_a_part_in_either_language) {
  const std::pair<const char*, std::vector<const char*>> parts[] = {
      {"ct-chest", {"Chest", "Lung", "Lunge", "Thorax", "thoracic"}},
      {"ct-abdomen", {"Abdomen", "Bauch", "Liver", "Leber", "Pelvis"}},
      {"ct-spine",
       {"Spine", "C-Spine", "CSPINE", "TSPINE", "LSPINE", "SSPINE", "lumbar", "HWS", "BWS", "LWS", "Wirbel",
        "vertebra"}},
      {"ct-skin-and-bone", {"Head", "Kopf", "Skull", "Brain", "cranium"}}};
  for (const auto& [scene, words] : parts) {
    for (const std::string word : words) {
      EXPECT_EQ(offered("CT", "", word + " 1.0"), scene) << word;
      EXPECT_EQ(offered("CT", word, ""), scene) << word;
    }
  }
}

/// "ct-chest ct-bone | mr-brain": those that suit, and the others.
std::string list_of(const std::string& first, const std::string& modality, bool has_vectors) {
  std::string list;
  bool others = false;
  for (const OfferedScene& scene : offered_scenes(first, modality, has_vectors)) {
    if (!scene.made_for.empty() && !others) list += "| ";
    others = others || !scene.made_for.empty();
    EXPECT_EQ(scene.made_for.empty(), !others) << "those that suit come first";
    list += scene.name + ' ';
  }
  return list;
}

TEST(StartingScene, comes_first_of_those_that_are_offered) {
  EXPECT_EQ(list_of("ct-chest", "CT", false),
            "ct-chest ct-skin-and-bone ct-bone ct-abdomen ct-spine ct-vessels | mr-brain flow ");
  EXPECT_EQ(list_of("mr-brain", "MR", true),
            "mr-brain flow | ct-skin-and-bone ct-bone ct-chest ct-abdomen ct-spine ct-vessels ");
  EXPECT_EQ(list_of("mr-brain", "OT", false),
            "mr-brain | ct-skin-and-bone ct-bone ct-chest ct-abdomen ct-spine ct-vessels flow ");
  EXPECT_EQ(offered_scenes("ct-chest", "CT", false).back().made_for, "a velocity field");
}

/// The list says of each scene that does not suit the scan what it was made for, not what the scan is.
TEST(StartingScene, says_what_the_others_were_made_for) {
  for (const std::string modality : {"CT", "MR", "PT", "OT", ""}) {
    for (const bool has_vectors : {false, true}) {
      for (const std::string& first : starting_scenes()) {
        for (const OfferedScene& scene : offered_scenes(first, modality, has_vectors)) {
          const bool is_ct = scene.name.starts_with("ct-"), is_mr = scene.name.starts_with("mr-");
          const bool suits = scene.name == first || (is_ct ? modality == "CT" : is_mr ? modality == "MR" : has_vectors);
          EXPECT_EQ(scene.made_for, suits   ? ""
                                    : is_ct ? "CT"
                                    : is_mr ? "MR"
                                            : "a velocity field")
              << scene.name << " for " << modality;
        }
      }
    }
  }
}

TEST(StartingScene, is_the_modalitys_where_nothing_is_known) {
  EXPECT_EQ(offered("CT", "", ""), "ct-skin-and-bone");
  EXPECT_EQ(offered("CT", "WHOLEBODY", "CT Body 3.0"), "ct-skin-and-bone");
  EXPECT_EQ(offered("CT", "", "overhead"), "ct-skin-and-bone") << "within a word nothing is meant";
  EXPECT_EQ(offered("MR", "CHEST", "thorax"), "mr-brain");
  EXPECT_EQ(offered("OT", "", ""), "mr-brain");
}

}  // namespace
}  // namespace palpate::modes
