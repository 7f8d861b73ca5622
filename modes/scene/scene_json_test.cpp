#include "modes/scene/scene_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <set>
#include <sstream>
#include <stdexcept>
#include <string>

#include "io/filter.h"
#include "io/fresh_folder.h"
#include "modes/types/mode_type.h"
#include "solver/analytical.h"
#include "solver/descent.h"
#include "solver/exact.h"
#include "solver/solver_type.h"

namespace palpate::modes {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

std::string error_of(const std::string& text) {
  try {
    scene_from_json(text, "mine.json");
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "accepted";
}

/// As a message lists them.
template <typename Types>
std::string names_of(const Types& types) {
  std::string names;
  for (const auto* const type : types) names.append(names.empty() ? "" : ", ").append(type->name);
  return names;
}

/// A scene with one surface mode, whose text is given members in place of its strength.
std::string with_surface(const std::string& members) {
  return R"({"version": 1, "modes": [{"type": "friction", "strength_n": 0.1}, {"type": "surface", )" + members + "}]}";
}

TEST(SceneJson, text_to_scene_to_text_is_stable) {
  for (const std::string& name : starting_scenes()) {
    const Scene scene = load_scene(name);
    const std::string text = to_json(scene);
    EXPECT_EQ(to_json(scene_from_json(text, name)), text) << name;
  }
  const std::string everything = R"({
    "version": 1, "name": "\u00e4\"", "stiffness_n_per_m": 0.1, "gradient_scale_mm": 1.7,
    "limits": {"force_limit_n": 2, "slew_limit_n_per_ms": 0.7, "ramp_s": 0.3, "speed_limit_m_per_s": 0.30000000000000004},
    "workspace": {"center_mm": [1, 2e-3, -3], "rotation": [[0, 1, 0], [0, 0, 1], [1, 0, 0]], "scale": 2.5, "fit": true},
    "solvers": {"analytical": false, "exact": true, "descent": true}, "subdivision": {"step_mm": 0.2, "most": 3},
    "sampling": {"value": "trilinear", "gradient": "central_differences"},
    "filter": {"type": "bilateral", "sigma_mm": 0.7, "sigma_value": 41},
    "tissues": [{"name": "air", "high": -400, "softness": 100, "color": "#56b4e9"},
                {"name": "soft tissue", "low": -400, "high": 200, "softness": 100}],
    "modes": [{"type": "surface", "from": "air", "to": "soft tissue", "strength_n": 1},
              {"type": "surface", "name": "s", "side": "both", "enabled": false, "color": "#0072B2",
               "strength_n": {"of": "low", "nodes": [[0, 0], [1, 2]], "interpolation": "monotone_cubic"},
               "gates": [{"of": "high", "nodes": [[0, 0], [1, 2]], "interpolation": "monotone_cubic"}]},
              {"type": "landmark", "shape": "point", "position_mm": [1, 2, 3], "strength_n": 1},
              {"type": "landmark", "shape": "line", "position_mm": [1, 2, 3], "direction": [0.1, 0, 2], "strength_n": 1},
              {"type": "force", "field": "gradient", "strength_n": {"of": "value", "nodes": [[7, 3]]}}]})";
  const Scene scene = scene_from_json(everything, "everything");
  EXPECT_EQ(to_json(scene_from_json(to_json(scene), "again")), to_json(scene));
  EXPECT_EQ(scene.limits.speed_m_per_s, 0.30000000000000004);
  EXPECT_EQ(scene.workspace.rotation[0].y, 1.0);
  EXPECT_EQ(scene.sampling.value, io::ValueMethod::trilinear);
  EXPECT_EQ(scene.sampling.gradient, io::GradientMethod::central_differences);
  EXPECT_EQ(scene.filter, (io::Filter{.type = io::find_filter_type("bilateral"), .sigma_mm = 0.7, .sigma_value = 41}));
  EXPECT_FALSE(scene.modes[1].enabled);
  EXPECT_EQ(scene.modes[1].gates[0].factor.interpolation(), Interpolation::monotone_cubic);
  EXPECT_EQ(scene.modes[3].direction, Vec3(0.1, 0, 2));
  EXPECT_EQ(scene.modes[4].strength_n(0), 3.0);
}

/// The key `solvers` with every solver, each not as it is by default.
std::string solvers_not_as_usual() {
  nlohmann::json solvers = nlohmann::json::object();
  for (const solver::SolverType* const type : solver::solver_types())
    solvers[std::string(type->name)] = !type->is_usual;
  return R"("solvers": )" + solvers.dump();
}

/// A scene that gives every key, none at its default.
std::string with_every_key() {
  return "{" + solvers_not_as_usual() + R"(,
    "version": 1, "name": "n", "description": "d", "stiffness_n_per_m": 411, "gradient_scale_mm": 1.7,
    "limits": {"force_limit_n": 2.1, "slew_limit_n_per_ms": 0.7, "ramp_s": 0.31, "speed_limit_m_per_s": 0.83},
    "workspace": {"center_mm": [1, 2, -3], "rotation": [[0, 1, 0], [0, 0, 1], [1, 0, 0]], "scale": 2.5, "fit": true},
    "subdivision": {"step_mm": 0.2, "most": 3, "proxy_step_mm": 0.17, "most_halts": 5},
    "filter": {"type": "bilateral", "sigma_mm": 0.6, "sigma_value": 41},
    "sampling": {"value": "trilinear", "gradient": "cubic"},
    "tissues": [{"name": "air", "high": -400, "softness": 100, "color": "#56b4e9"},
                {"name": "fat", "low": -400, "high": 200, "softness": 90},
                {"name": "bone", "low": 200, "softness": 80}],
    "structures": [{"name": "liver", "file": "/l.dcm", "segment": "Liver", "color": "#0072b2", "margin_mm": 4},
                   {"name": "aorta", "file": "/a.dcm", "segment": 3}],
    "modes": [
      {"type": "surface", "name": "a", "enabled": false, "color": "#112233", "side": "leaving",
       "strength_n": {"of": "gradient_per_mm", "nodes": [[1, 2], [3, 4]], "interpolation": "monotone_cubic"},
       "gates": [{"of": "low", "nodes": [[5, 0], [6, 0.5]]},
                 {"of": "high", "nodes": [[7, 0.25], [8, 0.5]], "interpolation": "monotone_cubic"},
                 {"of": "distance_mm", "structure": "aorta", "nodes": [[-9, 1], [10, 0]]}]},
      {"type": "surface", "name": "b", "enabled": true, "side": "both", "strength_n": 1.1},
      {"type": "surface", "name": "c", "enabled": true, "side": "entering", "strength_n": {"of": "value", "nodes": [[0, 3]]}},
      {"type": "surface", "enabled": true, "from": "air", "to": "fat", "strength_n": 1.2},
      {"type": "surface", "enabled": true, "structure": "liver", "level_mm": 2, "side": "leaving", "strength_n": 1.3},
      {"type": "keep_out", "enabled": true, "margin_mm": 7,
       "strength_n": {"of": "distance_mm", "structure": "liver", "nodes": [[11, 1], [12, 2]]}, "structure": "aorta",
       "gates": [{"of": "distance_mm", "structure": "liver", "nodes": [[2, 1], [3, 0]]}]},
      {"type": "keep_in", "enabled": true, "structure": "liver", "margin_mm": 8, "strength_n": 1.4,
       "gates": [{"of": "value", "nodes": [[0, 0], [1, 0.75]]}]},
      {"type": "force", "enabled": true, "field": "gradient", "strength_n": {"of": "vector", "nodes": [[13, 0.5]]}},
      {"type": "follow", "enabled": true, "field": "vector", "strength_n": 1.5},
      {"type": "friction", "enabled": true, "strength_n": 1.6},
      {"type": "tube", "enabled": true, "strength_n": 1.7},
      {"type": "landmark", "enabled": true, "shape": "point", "position_mm": [14, 15, 16], "strength_n": 1.8},
      {"type": "landmark", "enabled": true, "shape": "line", "position_mm": [17, 18, 19], "direction": [0, 0.6, 0.8],
       "strength_n": 1.9},
      {"type": "landmark", "enabled": true, "shape": "plane", "position_mm": [20, 21, 22], "direction": [0.6, 0.8, 0],
       "strength_n": 2}]})";
}

/// Read and written, its text says the same, key by key. So no key is lost or told as another, in either direction.
TEST(SceneJson, every_key_comes_back) {
  const auto json = nlohmann::json::parse(with_every_key());
  const auto again = nlohmann::json::parse(to_json(scene_from_json(json.dump(), "everything")));
  EXPECT_EQ(again, json) << nlohmann::json::diff(json, again).dump(1);
}

/// A whole number is taken as it is or refused: none that is too large becomes another one.
TEST(SceneJson, AWholeNumberThatIsTooLargeIsRefused) {
  const struct {
    const char *path, *before, *after;
    std::int64_t sound;
  } keys[] = {{"version", R"({"modes": [], "version": )", "}", 1},
              {"structures[0].segment",
               R"({"version": 1, "modes": [], "structures": [{"name": "a", "file": "/a.dcm", "segment": )", "}]}", 3},
              {"subdivision.most", R"({"version": 1, "modes": [], "subdivision": {"most": )", "}}", 2},
              {"subdivision.most_halts", R"({"version": 1, "modes": [], "subdivision": {"most_halts": )", "}}", 0},
              {"filter.width", R"({"version": 1, "modes": [], "filter": {"type": "median", "width": )", "}}", 5}};
  for (const auto& [path, before, after, sound] : keys) {
    const auto said = [&, &before = before, &after = after](const std::string& value) {
      return error_of(before + value + after);
    };
    EXPECT_EQ(said(std::to_string(sound)), "accepted") << path;
    // Their lowest 32 bits are those of the sound number.
    const std::string wrong[] = {std::to_string(sound + (std::int64_t{1} << 32)),
                                 std::to_string(sound - (std::int64_t{1} << 32)),
                                 std::to_string(sound + (std::int64_t{1} << 62)),
                                 std::to_string(static_cast<std::uint64_t>(sound) + (std::uint64_t{1} << 63))};
    for (const std::string& value : wrong) {
      EXPECT_EQ(said(value), "mine.json: " + std::string(path) + ": " + value + " is not a whole number");
    }
  }
}

/// What is written wrong is not left at its default in silence, whichever object it is in.
TEST(SceneJson, AKeyThatIsNoneIsRefusedInEveryObject) {
  const auto json = nlohmann::json::parse(with_every_key());
  std::set<std::string> objects;
  const auto leaves = json.flatten();
  for (const auto& [leaf, value] : leaves.items()) {
    for (nlohmann::json::json_pointer at(leaf); !at.empty();) {
      at = at.parent_pointer();
      if (json.at(at).is_object()) objects.insert(at.to_string());
    }
  }
  EXPECT_GT(objects.size(), 30U);
  for (const std::string& object : objects) {
    nlohmann::json wrong = json;
    wrong[nlohmann::json::json_pointer(object)]["no_such_key"] = 1;
    EXPECT_THAT(error_of(wrong.dump()), HasSubstr("no_such_key")) << object;
  }
}

TEST(SceneJson, a_filter_has_what_its_type_reads) {
  const auto filter_of = [](const std::string& filter) {
    return scene_from_json(R"({"version": 1, "modes": [], "filter": )" + filter + "}", "mine.json").filter;
  };
  using io::Filter, io::find_filter_type;
  EXPECT_EQ(filter_of(R"({"type": "none"})"), Filter{});
  EXPECT_EQ(filter_of(R"({"type": "gaussian", "sigma_mm": 2})"),
            (Filter{.type = find_filter_type("gaussian"), .sigma_mm = 2}));
  EXPECT_EQ(filter_of(R"({"type": "median", "width": 5})"), (Filter{.type = find_filter_type("median"), .width = 5}));
  EXPECT_EQ(filter_of(R"({"type": "non_local_means", "sigma_value": 9})"),
            (Filter{.type = find_filter_type("non_local_means"), .sigma_value = 9}));
  for (const Filter& filter : {Filter{.type = find_filter_type("gaussian"), .sigma_mm = 0.1},
                               Filter{.type = find_filter_type("median"), .width = 5},
                               Filter{.type = find_filter_type("non_local_means"), .sigma_value = 0.3}, Filter{}}) {
    EXPECT_EQ(filter_from_json(to_json(filter)), filter);
  }
  const auto refused = [](const std::string& filter) {
    return error_of(R"({"version": 1, "modes": [], "filter": )" + filter + "}");
  };
  EXPECT_EQ(refused(R"({"type": "sharpen"})"),
            "mine.json: filter.type: there is no \"sharpen\"; there are: none, " + names_of(io::filter_types()));
  EXPECT_THAT(refused(R"({"type": "median", "sigma_mm": 1})"), StartsWith("mine.json: filter.sigma_mm: "));
  EXPECT_EQ(refused(R"({"type": "median", "width": 4})"),
            "mine.json: filter.width: a median of 4 voxels is not offered; give 3 or 5");
  EXPECT_EQ(refused(R"({"type": "gaussian", "sigma_mm": 0})"),
            "mine.json: filter.sigma_mm: 0 mm is no width of a filter; give 0.1 to 10 mm");
  EXPECT_EQ(
      refused(R"({"type": "bilateral", "sigma_value": -1})"),
      "mine.json: filter.sigma_value: -1 is no difference of values; give the noise, in the scan's unit, above 0");
}

TEST(SceneJson, AFilterAloneIsCheckedAsOneOfAScene) {
  for (const char* const filter : {R"({"type": "median", "width": 4})", R"({"type": "gaussian", "sigma_mm": 0})"}) {
    EXPECT_THROW((void)filter_from_json(filter), std::invalid_argument) << filter;
  }
}

TEST(SceneJson, AFileThatIsNotThereIsNamedBeforeTheScenesThatAre) {
  try {
    load_scene("no/such scene.json");
    FAIL() << "accepted";
  } catch (const std::invalid_argument& error) {
    EXPECT_THAT(error.what(), StartsWith("no/such scene.json: no such scene file can be read"));
    for (const std::string& name : starting_scenes()) EXPECT_THAT(error.what(), HasSubstr(name));
  }
}

TEST(SceneJson, what_is_not_said_takes_the_default) {
  const Scene scene = scene_from_json(R"({"version": 1, "modes": []})", "empty");
  EXPECT_EQ(scene.stiffness_n_per_m, 400.0);
  EXPECT_EQ(scene.limits.force_n, 3.0);
  EXPECT_FALSE(scene.gradient_scale_mm.has_value());
  EXPECT_TRUE(scene.solvers.contains(solver::analytical_solver) && scene.solvers.contains(solver::exact_solver) &&
              !scene.solvers.contains(solver::descent_solver));
  EXPECT_EQ(scene.sampling.value, io::ValueMethod::cubic);
  EXPECT_EQ(scene.sampling.gradient, io::GradientMethod::gaussian);
}

TEST(SceneJson, every_error_names_the_file_and_the_path_of_the_bad_key) {
  EXPECT_THAT(error_of("{"), StartsWith("mine.json: parse error at line 1"));
  EXPECT_THAT(error_of("[]"), StartsWith("mine.json: scene: is not an object"));
  EXPECT_THAT(error_of(R"({"modes": []})"), StartsWith("mine.json: version: is missing"));
  EXPECT_THAT(error_of(R"({"version": 2, "modes": []})"), StartsWith("mine.json: version: 2 is not known"));
  EXPECT_THAT(error_of(R"({"version": 1})"), StartsWith("mine.json: modes: is missing"));
  EXPECT_THAT(error_of(R"({"version": 1, "modes": [], "stiffness": 3})"),
              StartsWith("mine.json: stiffness: there is no such key here; there are: "));
  EXPECT_THAT(error_of(R"({"version": 1, "modes": [], "stiffness_n_per_m": 0})"),
              StartsWith("mine.json: stiffness_n_per_m: 0 is not a number above 0"));
  EXPECT_THAT(
      error_of(R"({"version": 1, "modes": [{"type": "surfce", "strength_n": 1}]})"),
      StartsWith("mine.json: modes[0].type: there is no mode \"surfce\"; there are: " + names_of(mode_types())));
  EXPECT_THAT(
      error_of(with_surface(R"("strength_n": {"nodes": [[0, -2]]})")),
      StartsWith("mine.json: modes[1].strength_n.nodes[0][1]: -2 is negative; a strength is in newtons, 0 or more"));
  EXPECT_THAT(error_of(with_surface(R"("strength_n": 1, "gates": [{"of": "value", "nodes": [[0, 1], [1, -2]]}])")),
              StartsWith("mine.json: modes[1].gates[0].nodes[1][1]: -2 is negative; a gate is a factor, 0 or more"));
  EXPECT_THAT(error_of(with_surface(R"("strength_n": -0.5)")),
              StartsWith("mine.json: modes[1].strength_n: -0.5 is negative"));
  EXPECT_THAT(error_of(with_surface(R"("strength_n": {"nodes": [[1, 0], [0, 1]]})")),
              StartsWith("mine.json: modes[1].strength_n.nodes[1]: has to lie beyond"));
  EXPECT_THAT(error_of(with_surface(R"("strength_n": {"nodes": [[1, 0, 3]]})")),
              StartsWith("mine.json: modes[1].strength_n.nodes[0]: is not a list of 2"));
  EXPECT_THAT(error_of(with_surface(R"("strength_n": {"nodes": []})")),
              StartsWith("mine.json: modes[1].strength_n.nodes:"));
  EXPECT_THAT(
      error_of(with_surface(R"("strength_n": {"of": "color", "nodes": [[0, 1]]})")),
      StartsWith("mine.json: modes[1].strength_n.of: there is no \"color\"; there are: value, gradient_per_mm"));
  EXPECT_THAT(error_of(with_surface(R"("strength_n": 1, "gates": [{"of": "value", "nodes": [["a", 1]]}])")),
              StartsWith("mine.json: modes[1].gates[0].nodes[0][0]: \"a\" is not a number"));
  EXPECT_THAT(error_of(with_surface(R"("strength_n": 1, "field": "vector")")),
              StartsWith("mine.json: modes[1].field: there is no such key"));
  EXPECT_THAT(error_of(with_surface(R"("strength_n": 1, "from": "air", "to": "bone")")),
              StartsWith("mine.json: modes[1].from: there is no tissue \"air\""));
  EXPECT_EQ(error_of(with_surface(R"("strength_n": 1, "to": "bone")")), "mine.json: modes[1].from: is missing");
  EXPECT_EQ(error_of(with_surface(R"("strength_n": 1, "from": "air")")), "mine.json: modes[1].to: is missing");
  EXPECT_THAT(error_of(with_surface(R"("strength_n": 1, "from": "air", "to": "bone", "side": "both")")),
              StartsWith("mine.json: modes[1].side: the side follows"));
  EXPECT_THAT(error_of(R"({"version": 1, "modes": [], "workspace": {"rotation": [[2, 0, 0], [0, 1, 0], [0, 0, 1]]}})"),
              StartsWith("mine.json: workspace.rotation:"));
  EXPECT_THAT(error_of(R"({"version": 1, "modes": [], "workspace": {"rotation": [[0, 1, 0], [1, 0, 0], [0, 0, 1]]}})"),
              HasSubstr("mirror"));
  EXPECT_THAT(error_of(R"({"version": 1, "modes": [], "sampling": {"value": "linear"}})"),
              StartsWith("mine.json: sampling.value: there is no \"linear\"; there are: cubic, trilinear"));
  EXPECT_THAT(error_of(R"({"version": 1, "modes": [], "limits": {"force_limit_n": 1e999}})"),
              StartsWith("mine.json: "));
  EXPECT_THAT(
      error_of(R"({"version": 1, "modes": [], "tissues": [{"name": "a", "low": 2, "high": 1, "softness": 1}]})"),
      StartsWith("mine.json: tissues[0].low:"));
  EXPECT_THAT(error_of(R"({"version": 1, "modes": [], "name": "a", "name": "b"})"),
              StartsWith("mine.json: name: is given twice"));
  // A text from the network or a damaged file: no depth ends the program.
  for (const std::string open : {"[", R"({"a":)"}) {
    std::string nested = R"({"version": 1, "stiffness_n_per_m": )";
    for (int n = 0; n < 200'000; ++n) nested += open;
    EXPECT_THAT(error_of(nested), HasSubstr("mine.json: nested more than 64 deep"));
  }
  EXPECT_THAT(error_of(with_surface(R"("strength_n": {"nodes": [[0, 1]], "nodes": [[0, 2]]})")),
              HasSubstr("nodes: is given twice"));
  EXPECT_THAT(error_of(R"({"version": 1, "modes": [], "limits": {"ramp_s": 1}, "solvers": {}, "version": 1})"),
              StartsWith("mine.json: version: is given twice"));
}

TEST(SceneJson, a_list_of_numbers_stays_on_its_line) {
  const std::string text = to_json(
      scene_from_json(with_surface(R"("strength_n": {"of": "low", "nodes": [[0, 0], [1, 2], [5, 3]]})"), "mine.json"));
  EXPECT_THAT(text, HasSubstr(R"([[0.0,0.0],[1.0,2.0],[5.0,3.0]])"));
  EXPECT_THAT(text, HasSubstr("\n    {\n")) << "a mode begins a line";
}

/// A structure's file is found from the folder of the scene's file, from wherever the program was started.
TEST(SceneJson, the_files_of_structures_are_beside_the_scene) {
  const io::FreshFolder folder = io::temporary_folder();
  const auto file = folder.path() / "mine.json";
  std::ofstream(file) << R"({"version": 1, "modes": [], "structures": [
    {"name": "a", "file": "a.dcm", "segment": 1}, {"name": "b", "file": "../b/b.dcm", "segment": 1},
    {"name": "c", "file": "/c/c.dcm", "segment": 1}]})";
  for (const std::filesystem::path& name : {file, std::filesystem::proximate(file)}) {
    const Scene scene = load_scene(name.string());
    ASSERT_EQ(scene.structures.size(), 3U);
    EXPECT_EQ(scene.structures[0].file, folder.path() / "a.dcm");
    EXPECT_EQ(scene.structures[1].file, folder.path().parent_path() / "b/b.dcm");
    EXPECT_EQ(scene.structures[2].file, "/c/c.dcm");
  }
}

TEST(SceneJson, starting_scenes_are_found_by_name_and_are_the_files_of_the_folder) {
  const std::filesystem::path folder = PALPATE_SCENES;
  std::size_t files = 0;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    std::ostringstream text;
    text << std::ifstream(entry.path()).rdbuf();
    EXPECT_EQ(starting_scene_text(entry.path().stem().string()), text.str()) << entry.path();
    EXPECT_EQ(to_json(load_scene(entry.path().string())), to_json(load_scene(entry.path().stem().string())));
    ++files;
  }
  EXPECT_EQ(files, starting_scenes().size());
  try {
    load_scene("no-such-scene");
    FAIL();
  } catch (const std::invalid_argument& error) {
    for (const std::string& name : starting_scenes()) EXPECT_THAT(error.what(), HasSubstr(name));
  }
  EXPECT_THROW(load_scene("/"), std::invalid_argument);
}

}  // namespace
}  // namespace palpate::modes
