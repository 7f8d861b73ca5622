#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <map>
#include <stdexcept>

#include "plugin/messages/messages.h"
#include "plugin/recording/recording.h"
#include "plugin/recording/table_file.h"

namespace palpate::plugin {
namespace {

constexpr double not_a_number = std::numeric_limits<double>::quiet_NaN();

template <std::size_t count, typename T>
void print_all(TableFile& out, const T (&values)[count]) {
  for (const T& value : values) {
    out.print(",{}", value);
  }
}

/// Names of all structures of all scenes, and for each scene where each of them is in its ticks.
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
  double of(const TickRecord& tick, std::size_t column) const {
    const auto scene = place.find(tick.scene_epoch);
    const std::size_t n = scene == place.end() ? distance_count : scene->second[column];
    return n < distance_count ? tick.distance_mm[n] : not_a_number;
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
  TableFile out(file);
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
  out.print(",known_to_mm,scan_frame");
  const DistanceColumns distances(recording);
  std::map<std::uint32_t, int> scan_frames;  // by epoch
  for (const SceneRecord& scene : recording.scenes) {
    if (scene.frame) scan_frames[scene.epoch] = scene.frame->number;
  }
  for (const std::string& name : distances.names) out.print(",{}", quoted("distance_mm " + name));
  out.print("\n");
  for (std::size_t row = 0; row < recording.ticks.size(); ++row) {
    const TickRecord& tick = recording.ticks[row];
    out.print("{},{},{},{},{}", tick.index, tick.time_s, tick.dt_s, tick.pose_time_s, tick.heartbeat_s);
    print_all(out, tick.probe_m);
    print_all(out, tick.proxy_m);
    print_all(out, tick.force_n);
    print_all(out, tick.sent_n);
    out.print(",{},{},{},{}", tick.value, tick.residual_n, tick.error_bound_m, tick.change_part);
    const std::uint32_t counts[] = {tick.scene_epoch, tick.sub_steps,  tick.halts,        tick.iterations,
                                    tick.solver,      tick.outcome,    tick.safety,       tick.share_count,
                                    tick.buttons,     tick.fresh,      tick.stylus_state, tick.stylus_epoch,
                                    tick.commands,    tick.from_brick, tick.missed,       tick.late_ns};
    print_all(out, counts);
    print_all(out, tick.stage_ns);
    out.print(",{}", recording.known_to_mm.empty() ? not_a_number : recording.known_to_mm[row]);
    const auto scan_frame = scan_frames.find(tick.scene_epoch);
    out.print(",{}", scan_frame == scan_frames.end() ? std::string() : std::to_string(scan_frame->second));
    for (std::size_t n = 0; n < distances.names.size(); ++n) out.print(",{}", distances.of(tick, n));
    out.print("\n");
  }
  out.close();
} catch (const std::exception& error) {
  throw Refusal(say("cannot-write-is-the-disk-full", file.string(), error.what()));
}

}  // namespace palpate::plugin
