#include <fmt/os.h>

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>

#include "plugin/messages/messages.h"
#include "plugin/recording/recording.h"

namespace palpate::plugin {
namespace {

template <std::size_t count, typename T>
void print_all(fmt::ostream& out, const T (&values)[count]) {
  for (const T& value : values) {
    out.print(",{}", value);
  }
}

/// Names of all structures of all scenes, and for each scene where each of them is in its frames.
struct DistanceColumns {
  explicit DistanceColumns(const Recording& recording) {
    for (const SceneRecord& scene : recording.scenes) {
      for (const std::string& name : scene.structures) {
        if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
      }
    }
    for (const SceneRecord& scene : recording.scenes) {
      for (const std::string& name : names) {
        const auto found = std::find(scene.structures.begin(), scene.structures.end(), name);
        place[scene.epoch].push_back(static_cast<std::size_t>(found - scene.structures.begin()));
      }
    }
  }
  double of(const TickRecord& frame, std::size_t column) const {
    const auto scene = place.find(frame.scene_epoch);
    const std::size_t n = scene == place.end() ? distance_count : scene->second[column];
    return n < distance_count ? frame.distance_mm[n] : std::numeric_limits<double>::quiet_NaN();
  }
  std::vector<std::string> names;
  std::map<std::uint32_t, std::vector<std::size_t>> place;
};

/// As RFC 4180 has it.
std::string quoted(const std::string& name) {
  std::string text = "\"";
  for (const char c : name) text += c == '"' ? std::string("\"\"") : std::string(1, c);
  return text + "\"";
}

}  // namespace

void write_csv(const Recording& recording, const std::filesystem::path& file) try {
  fmt::ostream out = fmt::output_file(file.string());
  out.print("index,time_s,dt_s,pose_time_s,heartbeat_s");
  for (const char* vector : {"probe_m", "proxy_m", "force_n", "sent_n"}) {
    out.print(",{0}_x,{0}_y,{0}_z", vector);
  }
  out.print(
      ",value,residual_n,error_bound_m,change_part,scene_epoch,sub_steps,halts,iterations,solver,outcome,safety,"
      "share_count,buttons,fresh,stylus_state,stylus_epoch,commands,from_brick,missed,late_ns");
  for (const char* stage : stage_names) {
    out.print(",{}_ns", stage);
  }
  const DistanceColumns distances(recording);
  for (const std::string& name : distances.names) out.print(",{}", quoted("distance_mm " + name));
  out.print("\n");
  for (const TickRecord& frame : recording.frames) {
    out.print("{},{},{},{},{}", frame.index, frame.time_s, frame.dt_s, frame.pose_time_s, frame.heartbeat_s);
    print_all(out, frame.probe_m);
    print_all(out, frame.proxy_m);
    print_all(out, frame.force_n);
    print_all(out, frame.sent_n);
    out.print(",{},{},{},{}", frame.value, frame.residual_n, frame.error_bound_m, frame.change_part);
    const std::uint32_t counts[] = {frame.scene_epoch, frame.sub_steps,  frame.halts,        frame.iterations,
                                    frame.solver,      frame.outcome,    frame.safety,       frame.share_count,
                                    frame.buttons,     frame.fresh,      frame.stylus_state, frame.stylus_epoch,
                                    frame.commands,    frame.from_brick, frame.missed,       frame.late_ns};
    print_all(out, counts);
    print_all(out, frame.stage_ns);
    for (std::size_t n = 0; n < distances.names.size(); ++n) out.print(",{}", distances.of(frame, n));
    out.print("\n");
  }
  out.close();
} catch (const std::exception& error) {
  throw Refusal(say("cannot-write-is-the-disk-full", file.string(), error.what()));
}

}  // namespace palpate::plugin
