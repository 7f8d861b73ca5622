/// Each limit of a scene, reached and passed, with the path of the key that is told.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "modes/scene/scene.h"
#include "solver/analytical.h"
#include "solver/descent.h"
#include "solver/exact.h"
#include "solver/text/testing/not_finite.h"

namespace palpate::modes {
namespace {

Scene full() {
  Scene scene;
  scene.tissues = {{.name = "air", .low = -2000, .high = -400, .softness = 100},
                   {.name = "skin", .low = -400, .high = 200, .softness = 100}};
  scene.structures = {{.name = "liver", .file = "a.dcm", .segment = "Liver", .margin_mm = 2},
                      {.name = "aorta", .file = "a.dcm", .segment_number = 2}};
  scene.modes.resize(3);
  scene.modes[0] = {.type = "surface", .name = "s", .strength_n = TransferFunction(1.0), .from = "air", .to = "skin"};
  scene.modes[1] = {.type = "keep_out", .name = "k", .strength_n = TransferFunction(1.0), .structure = "liver"};
  scene.modes[2] = {.type = "landmark", .strength_n = TransferFunction(1.0), .shape = Shape::plane};
  scene.modes[2].gates = {{.of = Datum::value, .factor = TransferFunction(1.0)},
                          {.of = Datum::distance, .factor = TransferFunction(1.0), .structure = "aorta"}};
  return scene;
}

/// What is said of a scene that was changed; empty where it is taken.
std::string said_of(const std::function<void(Scene&)>& change) {
  Scene scene = full();
  change(scene);
  try {
    validate(scene);
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
  return "";
}

void expect_path(const std::string& said, const std::string& path) {
  EXPECT_EQ(said.rfind(path + ": ", 0), 0U) << said << "\nis not of " << path;
}

TEST(SceneLimits, AFullSceneIsTaken) {
  EXPECT_EQ(said_of([](Scene&) {}), "");
}

/// However small, but above zero and finite.
TEST(SceneLimits, EachSizeIsAboveZero) {
  const std::pair<const char*, std::function<void(Scene&, double)>> sizes[] = {
      {"stiffness_n_per_m", [](Scene& s, double x) { s.stiffness_n_per_m = x; }},
      {"limits.force_limit_n", [](Scene& s, double x) { s.limits.force_n = x; }},
      {"limits.slew_limit_n_per_ms", [](Scene& s, double x) { s.limits.slew_n_per_ms = x; }},
      {"limits.ramp_s", [](Scene& s, double x) { s.limits.ramp_s = x; }},
      {"limits.speed_limit_m_per_s", [](Scene& s, double x) { s.limits.speed_m_per_s = x; }},
      {"workspace.scale", [](Scene& s, double x) { s.workspace.scale = x; }},
      {"subdivision.step_mm", [](Scene& s, double x) { s.subdivision.step_mm = x; }},
      {"subdivision.proxy_step_mm", [](Scene& s, double x) { s.subdivision.proxy_step_mm = x; }},
      {"gradient_scale_mm", [](Scene& s, double x) { s.gradient_scale_mm = x; }},
      {"modes[1].margin_mm", [](Scene& s, double x) { s.modes[1].margin_mm = x; }},
      {"structures[0].margin_mm", [](Scene& s, double x) { s.structures[0].margin_mm = x; }},
      {"structures[1].margin_mm", [](Scene& s, double x) { s.structures[1].margin_mm = x; }}};
  for (const auto& [path, set] : sizes) {
    const auto said = [&, &set = set](double value) { return said_of([&](Scene& scene) { set(scene, value); }); };
    for (const double value : {1e-300, 1e-9, 1.0, 1e300}) EXPECT_EQ(said(value), "") << path << " " << value;
    for (const double value : {0.0, -1e-300, -1.0, nan, infinity, -infinity}) expect_path(said(value), path);
  }
}

TEST(SceneLimits, EachCountLiesBetweenItsEnds) {
  const std::pair<int Subdivision::*, int> counts[] = {{&Subdivision::most_halts, 0}, {&Subdivision::most, 1}};
  for (const auto& [count, least] : counts) {
    const char* const path = least == 0 ? "subdivision.most_halts" : "subdivision.most";
    const auto said = [&, &count = count](int value) {
      return said_of([&](Scene& scene) { scene.subdivision.*count = value; });
    };
    for (const int value : {least, 500, 1000}) EXPECT_EQ(said(value), "") << path;
    for (const int value : {least - 1, 1001}) expect_path(said(value), path);
  }
  for (const std::size_t modes : {32U, 33U}) {
    const std::string said = said_of([&](Scene& scene) {
      Mode one = scene.modes[0];
      one.name.clear();
      scene.modes.resize(modes, one);
    });
    EXPECT_EQ(said, modes == 32 ? "" : "modes: 33 are too many; at most 32 are allowed");
  }
}

/// Any rotation, and what rounding leaves of one; nothing that stretches, shears or mirrors.
TEST(SceneLimits, AWorkspaceIsTurnedByARotation) {
  std::mt19937 random(1);
  std::normal_distribution<double> normal;
  for (int n = 0; n < 50; ++n) {
    Vec3 axes[3];
    for (Vec3& axis : axes) {
      const double x = normal(random), y = normal(random), z = normal(random);
      axis = {x, y, z};
    }
    const Vec3 x = glm::normalize(axes[0]), y = glm::normalize(axes[1] - glm::dot(axes[1], x) * x);
    const glm::dmat3 rotation(x, y, glm::cross(x, y));
    const auto said = [&](const glm::dmat3& turned) {
      return said_of([&](Scene& scene) { scene.workspace.rotation = turned; });
    };
    EXPECT_EQ(said(rotation), "");
    for (int axis = 0; axis < 3; ++axis) {
      glm::dmat3 mirrored = rotation, stretched = rotation, rounded = rotation, none = rotation;
      mirrored[axis] = -mirrored[axis];
      stretched[axis] *= 1 + 1e-9;
      rounded[axis] *= 1 + 1e-10;
      none[axis][n % 3] = nan;
      EXPECT_EQ(said(mirrored), "workspace.rotation: is a mirror image: right would be left");
      EXPECT_EQ(said(stretched), "workspace.rotation: its axes are not of unit length and at right angles");
      EXPECT_EQ(said(rounded), "");
      EXPECT_EQ(said(none), "workspace.rotation: is not finite");
      glm::dmat3 sheared = rotation;
      sheared[axis] = glm::normalize(sheared[axis] + 1e-8 * rotation[(axis + 1) % 3]);
      expect_path(said(sheared), "workspace.rotation");
    }
  }
}

TEST(SceneLimits, APlaceIsFinite) {
  const std::pair<const char*, std::function<void(Scene&, const Vec3&)>> places[] = {
      {"workspace.center_mm", [](Scene& s, const Vec3& v) { s.workspace.center_mm = v; }},
      {"modes[2].position_mm", [](Scene& s, const Vec3& v) { s.modes[2].position_mm = v; }},
      {"modes[2].direction", [](Scene& s, const Vec3& v) { s.modes[2].direction = v; }},
      {"modes[0].level_mm", [](Scene& s, const Vec3& v) { s.modes[0].level_mm = v.x + v.y + v.z; }}};
  for (const auto& [path, set] : places) {
    for (int axis = 0; axis < 3; ++axis) {
      for (const double value : {nan, infinity, -infinity, 1e100}) {
        Vec3 v(1, 2, 3);
        v[axis] = value;
        const std::string said = said_of([&, &set = set](Scene& scene) { set(scene, v); });
        if (std::isfinite(value)) {
          EXPECT_EQ(said, "");
        } else {
          expect_path(said, path);
        }
      }
    }
  }
}

/// A direction has a length, however small it is.
TEST(SceneLimits, ADirectionHasALength) {
  for (const double length : {1e-99, 1e-101, 0.0}) {
    for (int axis = 0; axis < 3; ++axis) {
      const std::string said = said_of([&](Scene& scene) {
        scene.modes[2].direction = Vec3(0);
        scene.modes[2].direction[axis] = -length;
      });
      EXPECT_EQ(said, length > 1e-100 ? "" : "modes[2].direction: has no length");
    }
  }
}

/// Low below high, infinite or not; a soft end above zero, and no wider than the tissue.
TEST(SceneLimits, ATissueIsARangeWithSoftEnds) {
  const struct {
    double low, high, softness;
    const char* path;
  } tissues[] = {{0, 1, 1, ""},
                 {0, 1, 1e-12, ""},
                 {0, 1, 1.0001, ".softness"},
                 {0, 1, 0, ".softness"},
                 {0, 1, -1, ".softness"},
                 {0, 1, nan, ".softness"},
                 {1, 1, 1, ".low"},
                 {2, 1, 1, ".low"},
                 {nan, 1, 1, ".low"},
                 {0, nan, 1, ".low"},
                 {-infinity, 1, 50, ""},
                 {0, infinity, 50, ""},
                 {-infinity, infinity, 50, ""},
                 {infinity, infinity, 1, ".low"}};
  for (std::size_t which = 0; which < 2; ++which) {
    for (const auto& one : tissues) {
      const std::string said = said_of([&](Scene& scene) {
        scene.tissues[which].low = one.low;
        scene.tissues[which].high = one.high;
        scene.tissues[which].softness = one.softness;
      });
      if (*one.path == '\0') {
        EXPECT_EQ(said, "") << one.low << " " << one.high << " " << one.softness;
      } else {
        expect_path(said, "tissues[" + std::to_string(which) + "]" + one.path);
      }
    }
  }
}

/// No strength and no factor is below zero; which of several nodes it is, is told, and of a single one that it is it.
TEST(SceneLimits, NoStrengthIsNegative) {
  const std::pair<const char*, std::function<TransferFunction&(Scene&)>> functions[] = {
      {"modes[1].strength_n", [](Scene& s) -> TransferFunction& { return s.modes[1].strength_n; }},
      {"modes[2].gates[0].factor", [](Scene& s) -> TransferFunction& { return s.modes[2].gates[0].factor; }},
      {"modes[2].gates[1].factor", [](Scene& s) -> TransferFunction& { return s.modes[2].gates[1].factor; }}};
  for (const auto& [path, function] : functions) {
    const auto said = [&, &function = function](const TransferFunction& is) {
      return said_of([&](Scene& scene) { function(scene) = is; });
    };
    EXPECT_EQ(said(TransferFunction(0.0)), "");
    expect_path(said(TransferFunction(-1e-9)), path);
    expect_path(said(TransferFunction()), path);
    for (std::size_t node = 0; node < 3; ++node) {
      std::vector<Node> nodes{{0, 1}, {1, 0}, {2, 1}};
      nodes[node].value = -0.5;
      expect_path(said(TransferFunction(nodes)), std::string(path) + ".nodes[" + std::to_string(node) + "][1]");
    }
  }
}

/// Whatever is named has to be there, under its own path.
TEST(SceneLimits, WhatIsNamedIsThere) {
  const std::pair<const char*, std::function<void(Scene&)>> missing[] = {
      {"modes[0].type", [](Scene& s) { s.modes[0].type = "surfaces"; }},
      {"modes[0].from", [](Scene& s) { s.modes[0].from = "water"; }},
      {"modes[0].from", [](Scene& s) { s.modes[0].from.clear(); }},
      {"modes[0].to", [](Scene& s) { s.modes[0].to = "water"; }},
      {"modes[0].to", [](Scene& s) { s.modes[0].to.clear(); }},
      {"modes[0].to", [](Scene& s) { s.modes[0].to = "air"; }},
      {"modes[0].structure", [](Scene& s) { s.modes[0].structure = "spleen"; }},
      {"modes[1].structure", [](Scene& s) { s.modes[1].structure.clear(); }},
      {"modes[2].gates[1].structure", [](Scene& s) { s.modes[2].gates[1].structure = "spleen"; }},
      {"modes[1].strength_n.structure", [](Scene& s) { s.modes[1].strength_of = Datum::distance; }},
      {"tissues[1].name", [](Scene& s) { s.tissues[1].name.clear(); }},
      {"tissues[1].name", [](Scene& s) { s.tissues[1].name = "air"; }},
      {"structures[0].name", [](Scene& s) { s.structures[0].name.clear(); }},
      {"structures[1].name", [](Scene& s) { s.structures[1].name = "liver"; }},
      {"structures[1].file", [](Scene& s) { s.structures[1].file.clear(); }},
      {"structures[0].segment", [](Scene& s) { s.structures[0].segment.clear(); }},
      {"structures[1].segment", [](Scene& s) { s.structures[1].segment_number.reset(); }},
      {"modes[1].name", [](Scene& s) { s.modes[1].name = "s"; }}};
  for (const auto& [path, change] : missing) {
    if (std::string(path) == "tissues[1].name" || std::string(path).rfind("structures", 0) == 0) {
      expect_path(said_of([&, &change = change](Scene& scene) {
                    scene.modes.clear();
                    change(scene);
                  }),
                  path);
    } else {
      expect_path(said_of(change), path);
    }
  }
  EXPECT_EQ(said_of([](Scene& s) {
              s.modes[0].name.clear();
              s.modes[1].name.clear();
            }),
            "")
      << "many may have no name";
  EXPECT_EQ(said_of([](Scene& s) { s.modes[0].from = s.modes[0].to = ""; }), "") << "a side in place of a boundary";
}

TEST(SceneLimits, AColorIsSixHexadecimalDigits) {
  const std::pair<const char*, std::function<void(Scene&, const char*)>> colors[] = {
      {"tissues[0].color", [](Scene& s, const char* c) { s.tissues[0].color = c; }},
      {"structures[1].color", [](Scene& s, const char* c) { s.structures[1].color = c; }},
      {"modes[2].color", [](Scene& s, const char* c) { s.modes[2].color = c; }}};
  for (const auto& [path, set] : colors) {
    for (const char* const color : {"", "#000000", "#0072b2", "#ABCDEF", "#019aF9"}) {
      EXPECT_EQ(said_of([&, &set = set](Scene& scene) { set(scene, color); }), "") << color;
    }
    for (const char* const color : {"#", "#0072b", "#0072b22", "0072b22", "#0072g2", "#-072b2", "red", "##072b2"}) {
      expect_path(said_of([&, &set = set](Scene& scene) { set(scene, color); }), path);
    }
  }
}

TEST(SceneLimits, ASolverIsLeft) {
  for (unsigned on = 0; on < 8; ++on) {
    const std::string said = said_of([&](Scene& scene) {
      for (unsigned n = 0; n < 3; ++n) scene.solvers.set(*solver::solver_types()[n], ((on >> n) & 1) != 0);
    });
    EXPECT_EQ(said, on == 0 ? "solvers: all are switched off" : "");
  }
}

/// A filter that cannot be is refused under its own key.
TEST(SceneLimits, AFilterIsChecked) {
  const std::string said =
      said_of([](Scene& scene) { scene.filter = {.type = io::find_filter_type("gaussian"), .sigma_mm = -1}; });
  EXPECT_EQ(said.rfind("filter.", 0), 0U) << said;
}

TEST(SceneLimits, AScanIsReadAsItSays) {
  const io::FieldOptions options =
      field_options({.value = io::ValueMethod::trilinear, .gradient = io::GradientMethod::central_differences});
  EXPECT_EQ(options.value, io::ValueMethod::trilinear);
  EXPECT_EQ(options.gradient, io::GradientMethod::central_differences);
  EXPECT_EQ(field_options({}).value, io::ValueMethod::cubic);
  EXPECT_EQ(field_options({}).gradient, io::GradientMethod::gaussian);
}

/// Fitted, an uneven box that is turned any way, about its middle or another place, lies within the device's reach and
/// touches an end of it; not fitted, it is as large as it is said to be.
TEST(SceneLimits, AScanIsFittedIntoTheDevicesReach) {
  std::mt19937 random(2);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> uniform(1, 300);
  for (int n = 0; n < 300; ++n) {
    Vec3 axes[2], low, size, half_m;
    for (int i = 0; i < 3; ++i) {
      axes[0][i] = normal(random);
      axes[1][i] = normal(random);
      low[i] = 100 * normal(random);
      size[i] = uniform(random);
      half_m[i] = 1e-3 * uniform(random);
    }
    const Vec3 x = glm::normalize(axes[0]), y = glm::normalize(axes[1] - glm::dot(axes[1], x) * x);
    WorkspaceSettings settings{.rotation = {x, y, glm::cross(x, y)}, .scale = 1.75, .fit = n % 3 != 0};
    if (n % 2 == 0) settings.center_mm = low + 0.3 * size;
    const Workspace placed = place_workspace(settings, low, low + size, half_m);
    EXPECT_EQ(placed.rotation, settings.rotation);
    const Vec3 center = n % 2 == 0 ? low + 0.3 * size : low + 0.5 * size;
    EXPECT_LT(glm::distance(placed.center_mm, center), 1e-9);
    if (!settings.fit) {
      EXPECT_DOUBLE_EQ(placed.mm_per_m, 1750);
      continue;
    }
    double farthest = 0;  // of the device's reach along an axis
    for (const double i : {0.0, 1.0}) {
      for (const double j : {0.0, 1.0}) {
        for (const double k : {0.0, 1.0}) {
          const Vec3 corner = placed.to_device(low + Vec3(i, j, k) * size);
          for (int axis = 0; axis < 3; ++axis) farthest = std::max(farthest, std::abs(corner[axis]) / half_m[axis]);
        }
      }
    }
    EXPECT_NEAR(farthest, 1, 1e-9);
  }
  // A scan of a few hundredths of a millimetre in a hand's reach of a metre.
  EXPECT_NEAR(place_workspace({.fit = true}, Vec3(0), Vec3(0.04), Vec3(1)).mm_per_m, 0.02, 1e-12);
}

/// What a scene is before anything is said, as the documents have it.
TEST(SceneLimits, DefaultsAreAsDocumented) {
  const Scene scene;
  EXPECT_EQ(scene.stiffness_n_per_m, 400);
  EXPECT_EQ(scene.limits.force_n, 3);
  EXPECT_EQ(scene.limits.slew_n_per_ms, 1);
  EXPECT_EQ(scene.limits.ramp_s, 0.5);
  EXPECT_EQ(scene.limits.speed_m_per_s, 1);
  EXPECT_EQ(scene.workspace.scale, 1);
  EXPECT_FALSE(scene.workspace.fit);
  EXPECT_TRUE(scene.solvers.contains(solver::analytical_solver));
  EXPECT_TRUE(scene.solvers.contains(solver::exact_solver));
  EXPECT_FALSE(scene.solvers.contains(solver::descent_solver));
  EXPECT_EQ(scene.subdivision.step_mm, 0.1);
  EXPECT_EQ(scene.subdivision.most, 8);
  EXPECT_EQ(scene.subdivision.proxy_step_mm, 0.125);
  EXPECT_EQ(scene.subdivision.most_halts, 32);
  const Tissue tissue;
  EXPECT_EQ(tissue.low, 0);
  EXPECT_EQ(tissue.high, 0);
  EXPECT_EQ(tissue.softness, 0);
  const Mode mode;
  EXPECT_TRUE(mode.enabled);
  EXPECT_EQ(mode.level_mm, 0);
  EXPECT_EQ(mode.margin_mm, 3);
  EXPECT_EQ(mode.position_mm, Vec3(0));
  EXPECT_EQ(mode.direction, Vec3(0, 0, 1));
}

}  // namespace
}  // namespace palpate::modes
