#include "modes/scene/starting_scene.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "modes/scene/scene_json.h"

namespace palpate::modes {
namespace {

struct Part {
  std::string_view begins;  ///< a word, in capitals
  const char* scene;
};
// BodyPartExamined (PS3.16, annex L) and what technicians write, in English and German.
constexpr std::array parts{
    Part{"CHEST", "ct-chest"},         Part{"THORA", "ct-chest"},         Part{"LUNG", "ct-chest"},
    Part{"ABD", "ct-abdomen"},         Part{"LIVER", "ct-abdomen"},       Part{"PELVIS", "ct-abdomen"},
    Part{"BAUCH", "ct-abdomen"},       Part{"LEBER", "ct-abdomen"},       Part{"SPINE", "ct-spine"},
    Part{"CSPINE", "ct-spine"},        Part{"TSPINE", "ct-spine"},        Part{"LSPINE", "ct-spine"},
    Part{"SSPINE", "ct-spine"},        Part{"LUMBAR", "ct-spine"},        Part{"VERTEBRA", "ct-spine"},
    Part{"WIRBEL", "ct-spine"},        Part{"HWS", "ct-spine"},           Part{"BWS", "ct-spine"},
    Part{"LWS", "ct-spine"},           Part{"HEAD", "ct-skin-and-bone"},  Part{"BRAIN", "ct-skin-and-bone"},
    Part{"SKULL", "ct-skin-and-bone"}, Part{"CRANI", "ct-skin-and-bone"}, Part{"KOPF", "ct-skin-and-bone"}};

/// Of the first word that names a part of the body; null where none does.
const Part* part_in(const std::string& text) {
  const auto is_letter = [](char c) { return std::isalpha(static_cast<unsigned char>(c)) != 0; };
  for (auto at = text.begin(); at != text.end();) {
    at = std::find_if(at, text.end(), is_letter);
    const auto end = std::find_if_not(at, text.end(), is_letter);
    std::string word(at, end);
    std::ranges::transform(word, word.begin(),
                           [](char c) { return static_cast<char>(std::toupper(static_cast<unsigned char>(c))); });
    for (const Part& part : parts) {
      if (word.starts_with(part.begins)) return &part;
    }
    at = end;
  }
  return nullptr;
}

const Part* part_of(const std::string& body_part, const std::string& description) {
  const Part* const part = part_in(body_part);
  return part != nullptr ? part : part_in(description);
}

std::string scene_of(const std::string& modality, const std::string& body_part, const std::string& description) {
  if (modality != "CT") return "mr-brain";
  const Part* const part = part_of(body_part, description);
  return part != nullptr ? part->scene : "ct-skin-and-bone";
}

}  // namespace

std::string starting_scene(const io::Series& series) {
  return scene_of(series.modality, series.details.body_part, series.description);
}

std::string starting_scene(const io::Volume& volume) {
  return volume.vectors ? "flow" : scene_of(volume.modality, volume.body_part, volume.description);
}

std::string part_of_body(const io::Volume& volume) {
  const Part* const part = part_of(volume.body_part, volume.description);
  return part != nullptr ? std::string(part->begins) : std::string();
}

bool is_of_head(const io::Volume& volume) {
  const Part* const part = part_of(volume.body_part, volume.description);
  return part != nullptr && part->scene == std::string_view("ct-skin-and-bone");
}

std::vector<OfferedScene> offered_scenes(const std::string& first, const std::string& modality, bool has_vectors) {
  std::vector<OfferedScene> offered;
  for (const std::string& name : starting_scenes()) {
    const std::string kind = name.starts_with("ct-") ? "CT" : name.starts_with("mr-") ? "MR" : "";
    const bool suits = name == first || (kind.empty() ? has_vectors : kind == modality);
    offered.push_back({name, suits ? "" : kind.empty() ? "a velocity field" : kind});
  }
  const auto rank = [&](const OfferedScene& scene) { return scene.name == first ? 0 : scene.made_for.empty() ? 1 : 2; };
  std::ranges::stable_sort(offered, {}, rank);
  return offered;
}

}  // namespace palpate::modes
