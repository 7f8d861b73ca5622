// Each message of the module's table, as it is said.

#include "modes/messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <exception>
#include <functional>
#include <string>
#include <vector>

#include "modes/scene/edit_text.h"
#include "modes/scene/scene_json.h"
#include "solver/solver_type.h"
#include "solver/text/testing/shown.h"

namespace palpate::modes {
namespace {

using testing::Provoked;
using testing::said_when;

std::string refusal_of(const std::string& scene) {
  try {
    scene_from_json(scene, "mine.json");
  } catch (const std::exception& error) {
    return error.what();
  }
  return "accepted";
}

std::string scene(const std::string& members) {
  return R"({"version": 1, "modes": [{"type": "friction", "strength_n": 0.1}], )" + members + "}";
}

std::string surface(const std::string& members) {
  return R"({"version": 1, "modes": [{"type": "surface", )" + members + "}]}";
}

std::string tissues(const std::string& list, const std::string& of_mode = "") {
  return R"({"version": 1, "tissues": [)" + list + R"(], "modes": [{"type": "surface", "strength_n": 1)" + of_mode +
         "}]}";
}

std::string many_modes() {
  std::string modes;
  for (int n = 0; n < 1000; ++n) modes += std::string(n ? "," : "") + R"({"type": "friction", "strength_n": 0.1})";
  return R"({"version": 1, "modes": [)" + modes + "]}";
}

/// The key `solvers`, with every solver switched off.
std::string no_solvers() {
  std::string solvers;
  for (const solver::SolverType* const type : solver::solver_types())
    solvers += (solvers.empty() ? "\"" : ", \"") + std::string(type->name) + "\": false";
  return R"("solvers": {)" + solvers + "}";
}

const std::string air = R"({"name": "air", "high": -400, "softness": 100})";
const std::string bone = R"({"name": "bone", "low": 300, "softness": 100})";

/// What a file cannot hold, and a program that makes its own scenes may.
std::vector<Provoked> provoke_scenes_of_programs() {
  const auto refusal = [](const std::function<void(Scene&)>& change) {
    Scene scene = scene_from_json(surface(R"("strength_n": 1)"), "mine");
    change(scene);
    return said_when([&] { validate(scene); });
  };
  return {
      {"no-such-scene-file-can-be-read", said_when([] { load_scene("absent"); })},
      {"no-such-edits-can-be-read", said_when([] { load_edits("absent"); })},
      {"missing-strength", refusal([](Scene& scene) { scene.modes[0].strength_n = {}; })},
      {"not-finite", refusal([](Scene& scene) { scene.workspace.center_mm = glm::dvec3(std::nan("")); })},
      {"workspace-fit-the-scan-or-the-device",
       said_when([] { place_workspace({.fit = true}, glm::dvec3(0), glm::dvec3(0), glm::dvec3(0.1)); })},
  };
}

std::vector<Provoked> provoke_scenes() {
  const std::vector<Provoked> texts{
      {"not-json", "{"},
      {"not-an-object-in-braces", "[]"},
      {"is-missing", R"({"modes": []})"},
      {"not-known", R"({"version": 2, "modes": []})"},
      {"there-is-no-such-key-here", scene(R"("stiffness": 3)")},
      {"not-a-number-above-0", scene(R"("stiffness_n_per_m": 0)")},
      {"there-is-no-mode", R"({"version": 1, "modes": [{"type": "surfce", "strength_n": 1}]})"},
      {"negative-value", surface(R"("strength_n": {"nodes": [[0, -1]]})")},
      {"there-is-no-such-name", surface(R"("strength_n": {"of": "color", "nodes": [[0, 1]]})")},
      {"not-a-number", scene(R"("stiffness_n_per_m": "hard")")},
      {"not-a-whole-number", scene(R"("subdivision": {"most": 1.5})")},
      {"not-true-or-false", scene(R"("workspace": {"fit": 1})")},
      {"not-a-text-in-quotes", scene(R"("name": 3)")},
      {"not-a-list", R"({"version": 1, "modes": 3})"},
      {"not-a-list-of", surface(R"("strength_n": {"nodes": [[1, 0, 3]]})")},
      {"given-twice", scene(R"("name": "a", "name": "b")")},
      {"used-twice", tissues(air + "," + air)},
      {"nodes-there-are-none", surface(R"("strength_n": {"nodes": []})")},
      {"not-a-usable-number", surface(R"("strength_n": {"nodes": [[0, 1e31]]})")},
      {"nodes-do-not-ascend", surface(R"("strength_n": {"nodes": [[1, 0], [0, 1]]})")},
      {"there-is-no-tissue-in-tissues", surface(R"("strength_n": 1, "from": "air", "to": "bone")")},
      {"side-follows-from-the-tissues", surface(R"("strength_n": 1, "from": "air", "to": "bone", "side": "both")")},
      {"boundary-lies-between-two-different-tissues", tissues(air + "," + bone, R"(, "from": "air", "to": "air")")},
      {"low-not-below-high", tissues(R"({"name": "a", "low": 2, "high": 1, "softness": 1})")},
      {"not-above-0-and-at-most", tissues(R"({"name": "a", "low": 0, "high": 1, "softness": 3})")},
      {"axes-are-not-of-unit-length", scene(R"("workspace": {"rotation": [[2, 0, 0], [0, 1, 0], [0, 0, 1]]})")},
      {"mirror-image", scene(R"("workspace": {"rotation": [[0, 1, 0], [1, 0, 0], [0, 0, 1]]})")},
      {"not-a-color-such-as-0072b2", surface(R"("strength_n": 1, "color": "red")")},
      {"no-length",
       R"({"version": 1, "modes": [{"type": "landmark", "shape": "plane", "position_mm": [0,0,0], "direction": [0,0,0], "strength_n": 1}]})"},
      {"all-are-switched-off", scene(no_solvers())},
      {"not-between-0-and-1000", scene(R"("subdivision": {"most_halts": 2000})")},
      {"not-between-1-and-1000", scene(R"("subdivision": {"most": 0})")},
      {"too-many", many_modes()},
  };
  std::vector<Provoked> said;
  for (const auto& [wanted, text] : texts) said.push_back({wanted, refusal_of(text)});
  const std::vector<Provoked> more = provoke_scenes_of_programs();
  said.insert(said.end(), more.begin(), more.end());
  return said;
}

TEST(MessagesOfScenes, EachIsShown) {
  testing::expect_all_shown({messages::scenes}, provoke_scenes(), {}, PALPATE_SOURCES);
}

}  // namespace
}  // namespace palpate::modes
