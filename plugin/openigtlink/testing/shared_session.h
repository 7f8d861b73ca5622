#pragma once

/// A session on a ball of soft tissue, served to clients of this process.

#include <glm/geometric.hpp>
#include <memory>
#include <thread>

#include "device/simulated/simulated_stylus.h"
#include "modes/scene/scene_json.h"
#include "plugin/app/live_session.h"
#include "plugin/openigtlink/image.h"
#include "plugin/openigtlink/serve.h"
#include "plugin/openigtlink/sharing.h"
#include "plugin/openigtlink/testing/stepped_server.h"
#include "plugin/testing/session_rig.h"
#include "plugin/testing/test_clocks.h"
#include "testdata/scan.h"

namespace palpate::plugin::igtl::testing {

inline std::shared_ptr<const io::Volume> ball_of_tissue() {
  return std::make_shared<const io::Volume>(
      testdata::scan(testdata::make_sphere(25), testdata::make_geometry({.size = glm::ivec3(60)})));
}

/// 5 mm outside the top of the ball, or 3 mm below it.
inline std::shared_ptr<device::SimulatedStylus> held_at(double y_m) {
  auto stylus = std::make_shared<device::SimulatedStylus>();
  stylus->follow(std::vector<device::Waypoint>{{.time = 0, .position = {0, 0.03, 0}},
                                               {.time = 0.4, .position = {0, y_m, 0}},
                                               {.time = 1000, .position = {0, y_m, 0}}});
  return stylus;
}

struct SharedSession {
  explicit SharedSession(LiveSession::Start start = LiveSession::Start::feeling, double y_m = 0.022,
                         const modes::Scene& scene = modes::load_scene("ct-skin-and-bone"))
      : stylus(held_at(y_m)) {
    session.set_clock([](double period_s) { return std::make_unique<plugin::testing::UnhurriedClock>(period_s); });
    session.set_scan(ball_of_tissue(), scene);
    session.connect(stylus, start);
    const auto load_it = [this](const std::string& folder, const io::Progress& /*progress*/) {
      if (!load) throw std::runtime_error("nothing at " + folder);
      return load(folder);
    };
    sharing = std::make_unique<Sharing>(session, server, received, threads, changes_of(session, load_it));
  }
  ~SharedSession() {
    sharing.reset();
    session.disconnect();
  }
  SharedSession(const SharedSession&) = delete;
  SharedSession& operator=(const SharedSession&) = delete;

  TickRecord last_tick() const {
    TickRecord tick;
    const std::uint64_t written = session.ticks()->written();
    if (written > 0) session.ticks()->read(written - 1, tick);
    return tick;
  }
  void look() {
    session.heartbeat();
    sharing->look();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  /// Whether the condition becomes true within a minute: the machine may be busy.
  template <typename Holds>
  bool comes(const Holds& holds) {
    const auto end = std::chrono::steady_clock::now() + std::chrono::minutes(1);
    while (std::chrono::steady_clock::now() < end) {
      look();
      if (holds()) return true;
    }
    return false;
  }
  void look_for(std::chrono::milliseconds time) {
    for (const auto end = std::chrono::steady_clock::now() + time; std::chrono::steady_clock::now() < end;) look();
  }

  std::function<LoadedScan(const std::string&)> load;
  Server server{{.port = 0}};
  std::shared_ptr<device::SimulatedStylus> stylus;
  LiveSession session;
  Received received;
  JobThreads threads;
  std::unique_ptr<Sharing> sharing;
};

/// A label map of a ball in a lattice of 1 mm, LPS.
inline Message ball_of_labels(const std::string& name, const glm::dvec3& center_mm, double radius_mm,
                              std::uint8_t label = 1) {
  constexpr int size = 60;
  Bytes voxels;
  Image image;
  image.size = glm::ivec3(size);
  image.along = {glm::dvec3(1, 0, 0), glm::dvec3(0, 1, 0), glm::dvec3(0, 0, 1)};
  image.first = glm::dvec3(-0.5 * (size - 1));
  for (int k = 0; k < size; ++k) {
    for (int j = 0; j < size; ++j) {
      for (int i = 0; i < size; ++i) {
        const bool inside = glm::distance(image.first + glm::dvec3(i, j, k), center_mm) < radius_mm;
        voxels.push_back(inside ? label : 0);
      }
    }
  }
  image.voxels = voxels;
  return {.type = "IMAGE", .device = name, .content = content_of(image)};
}

}  // namespace palpate::plugin::igtl::testing
