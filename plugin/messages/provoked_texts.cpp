#include <cmath>
#include <cstdint>
#include <exception>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/fields/volume_fields.h"
#include "modes/scene/scene_json.h"
#include "plugin/cli/solve_json.h"
#include "plugin/messages/provoked.h"
#include "plugin/messages/provoked_scans.h"
#include "solver/balance.h"
#include "testdata/sanitized.h"

namespace palpate::plugin::testing {
namespace {

std::string refusal_of(const std::string& scene) {
  try {
    modes::scene_from_json(scene, "mine.json");
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

const std::string air = R"({"name": "air", "high": -400, "softness": 100})";
const std::string bone = R"({"name": "bone", "low": 300, "softness": 100})";

std::string error_of(const std::string& line, SolverChoice solver = SolverChoice::chain) {
  return nlohmann::json::parse(solve_line(line, {.solver = solver}).json).value("error", "solved");
}

std::string balance(const std::string& primitives, const std::string& more = "") {
  return R"({"id":1,"stiffness":400,"probe":[0,0,-0.001])" + more + R"(,"primitives":)" + primitives + "}";
}

const std::string plane = R"([{"type":"plane","strength":2,"position":[0,0,0],"direction":[0,0,1]}])";

/// What a file cannot hold, and a program that makes its own scenes may.
std::vector<Provoked> provoke_scenes_of_programs() {
  const auto refusal = [](const std::function<void(modes::Scene&)>& change) {
    modes::Scene scene = modes::scene_from_json(surface(R"("strength_n": 1)"), "mine");
    change(scene);
    return said_when([&] { modes::validate(scene); });
  };
  auto ball = std::make_shared<io::Volume>();
  ball->geometry.dimensions = {2, 2, 1};
  ball->geometry.slice_positions = {glm::dvec3(0)};
  ball->voxels = std::vector<std::int16_t>(4);
  return {
      {"is missing; it is {}", refusal([](modes::Scene& scene) { scene.modes[0].strength_n = {}; })},
      {"is not finite", refusal([](modes::Scene& scene) { scene.workspace.center_mm = glm::dvec3(std::nan("")); })},
      {"workspace.fit: the scan or the device has no extent",
       said_when([] { modes::place_workspace({.fit = true}, glm::dvec3(0), glm::dvec3(0), glm::dvec3(0.1)); })},
      {"a scan offers its value, its gradient, the values on both sides of a boundary and the direction of tubes, and "
       "vectors only where velocities were measured along three directions",
       said_when([&] { io::VolumeFields(ball, io::FieldSet::vector, 1); })},
      {"the scale of the gradient has to be above 0 mm", said_when([&] { io::GradientKernel(ball, 0); })},
  };
}

}  // namespace

std::vector<Provoked> provoke_scenes() {
  const std::vector<Provoked> texts{
      {"{}: parse error at {}", "{"},
      {"is not an object in braces", "[]"},
      {"is missing", R"({"modes": []})"},
      {"{} is not known; this program reads {}", R"({"version": 2, "modes": []})"},
      {"there is no such key here; there are: {}", scene(R"("stiffness": 3)")},
      {"{} is not a number above 0; it is in {}", scene(R"("stiffness_n_per_m": 0)")},
      {R"(there is no mode "{}"; there are: {})", R"({"version": 1, "modes": [{"type": "surfce", "strength_n": 1}]})"},
      {"{} is negative; a strength is in newtons, 0 or more", surface(R"("strength_n": -1)")},
      {"{} is negative; {}, 0 or more", surface(R"("strength_n": {"nodes": [[0, -1]]})")},
      {R"(there is no "{}"; there are: {})", surface(R"("strength_n": {"of": "color", "nodes": [[0, 1]]})")},
      {"{} is not a number", scene(R"("stiffness_n_per_m": "hard")")},
      {"{} is not a whole number", scene(R"("subdivision": {"most": 1.5})")},
      {"{} is not true or false", scene(R"("workspace": {"fit": 1})")},
      {"{} is not a text in quotes", scene(R"("name": 3)")},
      {"is not a list", R"({"version": 1, "modes": 3})"},
      {"is not a list of {}", surface(R"("strength_n": {"nodes": [[1, 0, 3]]})")},
      {"is given twice", scene(R"("name": "a", "name": "b")")},
      {R"("{}" is used twice)", tissues(air + "," + air)},
      {"nodes: there are none; at least one is needed", surface(R"("strength_n": {"nodes": []})")},
      {"{}: is not a usable number (finite, at most 1e30)", surface(R"("strength_n": {"nodes": [[0, 1e31]]})")},
      {"{}: has to lie beyond the node before (nodes ascend in their first number)",
       surface(R"("strength_n": {"nodes": [[1, 0], [0, 1]]})")},
      {R"(there is no tissue "{}" in tissues)", surface(R"("strength_n": 1, "from": "air", "to": "bone")")},
      {"the side follows from the tissues; leave out side, or from and to",
       surface(R"("strength_n": 1, "from": "air", "to": "bone", "side": "both")")},
      {"a boundary lies between two different tissues", tissues(air + "," + bone, R"(, "from": "air", "to": "air")")},
      {"has to be below high", tissues(R"({"name": "a", "low": 2, "high": 1, "softness": 1})")},
      {"{} is not above 0 and at most high - low", tissues(R"({"name": "a", "low": 0, "high": 1, "softness": 3})")},
      {"its axes are not of unit length and at right angles",
       scene(R"("workspace": {"rotation": [[2, 0, 0], [0, 1, 0], [0, 0, 1]]})")},
      {"is a mirror image: right would be left",
       scene(R"("workspace": {"rotation": [[0, 1, 0], [1, 0, 0], [0, 0, 1]]})")},
      {R"("{}" is not a color such as "#0072b2")", surface(R"("strength_n": 1, "color": "red")")},
      {"has no length",
       R"({"version": 1, "modes": [{"type": "landmark", "shape": "plane", "position_mm": [0,0,0], "direction": [0,0,0], "strength_n": 1}]})"},
      {"all are switched off", scene(R"("solvers": {"analytical": false, "exact": false, "descent": false})")},
      {"{} is not between 0 and 1000", scene(R"("subdivision": {"most_halts": 2000})")},
      {"{} is not between 1 and 1000", scene(R"("subdivision": {"most": 0})")},
      {"{} are too many; there may be {}", many_modes()},
  };
  std::vector<Provoked> said;
  for (const auto& [wanted, text] : texts) said.push_back({wanted, refusal_of(text)});
  const std::vector<Provoked> more = provoke_scenes_of_programs();
  said.insert(said.end(), more.begin(), more.end());
  return said;
}

std::vector<Provoked> provoke_balances() {
  return {
      {"not JSON: {}", error_of("hello")},
      {"nested more than {} deep", error_of(std::string(100, '['))},
      {R"("{}" is given twice)", error_of(R"({"id":1,"id":2})")},
      {"longer than {} bytes", error_of(std::string(20'000'000, ' '))},
      {"the line is empty", error_of("  ")},
      {"not a JSON object but of type {}", error_of("[]")},
      {"not an object", error_of(balance("[3]"))},
      {"{} is missing", error_of("{}")},
      {"{} is not a number", error_of(R"({"stiffness":"a"})")},
      {"{} is not an array of three numbers", error_of(R"({"stiffness":400,"probe":[1,2]})")},
      {R"(strength is neither a number nor "inf")", error_of(balance(R"([{"type":"plane","strength":"much"}])"))},
      {"type is not a string", error_of(balance(R"([{"type":3}])"))},
      {R"(type "{}" is unknown; there are force, plane, line and point)", error_of(balance(R"([{"type":"wall"}])"))},
      {"{} is not finite{}", solver::describe({.field = solver::Field::probe})},
      {"{} is negative ({})", error_of(balance(R"([{"type":"point","strength":-1,"position":[0,0,0]}])"))},
      {"{} is not positive ({})", error_of(R"({"id":1,"stiffness":0,"probe":[0,0,0],"primitives":[]})")},
      {"{} has no length ({})", error_of(balance(R"([{"type":"force","strength":1,"direction":[0,0,0]}])"))},
      {"{} is out of range ({}): at most {}", error_of(R"({"id":1,"stiffness":1e60,"probe":[0,0,0],"primitives":[]})")},
      {"id is neither a string nor a number", error_of(R"({"id":[1]})")},
      {"primitives is not an array", error_of(balance("3"))},
      {"the {} solver does not fit this configuration",
       error_of(balance(R"([{"type":"plane","strength":2,"position":[0,0,0],"direction":[0.1,0,1]},)"
                        R"({"type":"line","strength":0.2,"position":[0,0,0],"direction":[1,2,3]}])"),
                SolverChoice::analytical)},
      {"has infinite strength, but no point meets it together with the other hard constraints: it stays {} m away "
       "(taken "
       "as met: {} of the largest distance between probe and constraints)",
       error_of(balance(R"([{"type":"point","strength":"inf","position":[0,0,0]},)"
                        R"({"type":"point","strength":"inf","position":[0.01,0,0]}])"))},
  };
}

std::vector<Provoked> provoke_everything() {
  std::vector<Provoked> all;
  for (const auto& provoke : {provoke_scenes, provoke_balances, provoke_files, provoke_headers, provoke_pixels,
                              provoke_programs, provoke_recordings}) {
    const std::vector<Provoked> some = provoke();
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

bool cannot_be_had_here(const std::string& message) {
  return testdata::is_sanitized && message.find("needs more memory than there is") != std::string::npos;
}

}  // namespace palpate::plugin::testing
