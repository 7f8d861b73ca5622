#pragma once

/// Shared by tests of the session: a slab to press on, and a press.

#include <memory>
#include <string>
#include <vector>

#include "device/simulated/simulated_stylus.h"
#include "modes/scene/scene_json.h"
#include "plugin/recording/replay.h"
#include "plugin/session/session.h"
#include "plugin/testing/test_files.h"
#include "testdata/analytic.h"

namespace palpate::plugin::testing {

/// A slab of soft tissue below z = top_mm in the patient (z points to the head), with bone from 10 mm below its surface
/// on.
inline std::shared_ptr<const io::FieldSource> slab(double top_mm = 0) {
  const std::vector<testdata::Layer> layers{{.depth = -top_mm, .value = testdata::soft_tissue_hu},
                                            {.depth = 10 - top_mm, .value = testdata::bone_hu}};
  return std::make_shared<testdata::AnalyticSource>(testdata::make_slab({0, 0, -1}, layers), 1.5);
}

inline Snapshot snapshot(const std::string& scene_name, const std::shared_ptr<const io::FieldSource>& source,
                         double change_s = 0.3) {
  const modes::Scene scene = modes::load_scene(scene_name);
  return {.plan = std::make_shared<const modes::Plan>(modes::make_plan(scene, source->available(), {})),
          .source = source,
          .limits = limits_for(scene.limits, device::SimulatedStylus().specification()),
          .change_s = change_s};
}

/// Down on to the skin, through it to the bone, and up again: 6 s.
inline std::vector<device::Waypoint> press() {
  return {{.time = 0, .position = {0, 0.02, 0}},   {.time = 1, .position = {0, 0.02, 0}},
          {.time = 2, .position = {0, -0.003, 0}}, {.time = 2.5, .position = {0, -0.003, 0}},
          {.time = 4, .position = {0, -0.018, 0}}, {.time = 4.5, .position = {0, -0.018, 0}},
          {.time = 5.5, .position = {0, 0.02, 0}}, {.time = 6, .position = {0, 0.02, 0}}};
}

/// Held 3 mm below the skin from the first moment on.
inline std::vector<device::Waypoint> hold(double y_m = -0.003) {
  return {{.time = 0, .position = {0, 0.004, 0}},
          {.time = 0.5, .position = {0, y_m, 0}},
          {.time = 100, .position = {0, y_m, 0}}};
}

inline std::shared_ptr<device::SimulatedStylus> stylus(const std::vector<device::Waypoint>& path,
                                                       std::uint64_t seed = 1) {
  device::SimulatedDevice model;
  model.hand.tremor_seed = seed;
  auto made = std::make_shared<device::SimulatedStylus>(model);
  made->follow(path);
  return made;
}

}  // namespace palpate::plugin::testing
