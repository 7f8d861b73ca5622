#include "plugin/bench/soak.h"

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <optional>
#include <random>
#include <span>
#include <thread>
#include <utility>

#include "device/simulated/simulated_stylus.h"
#include "modes/scene/scene_json.h"
#include "plugin/app/running_session.h"
#include "plugin/bench/heap_use.h"
#include "testdata/analytic.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

constexpr const char* scene_names[] = {"ct-skin-and-bone", "ct-bone", "ct-vessels"};
constexpr const char* scan_names[] = {"ball", "egg"};
constexpr const char* nothing = "nothing";  // what is felt at the end of a cycle, when no scan is held in memory
constexpr double rest_s = 1;                // for so long

std::shared_ptr<const io::Volume> make_scan(const std::string& name) {
  testdata::Phantom phantom = testdata::make_sphere(25);
  phantom.bodies.push_back(testdata::make_sphere(15, testdata::bone_hu).bodies.front());
  testdata::Grid grid;
  grid.size = glm::ivec3(64);
  if (name == "egg") {
    grid.spacing = {1.0, 1.0, 1.2};
    grid.size.z = 54;
  }
  return std::make_shared<const io::Volume>(testdata::scan(phantom, testdata::make_geometry(grid)));
}

/// Scans as if loaded: one at a time, made again at every change.
class Scans {
 public:
  Snapshot operator()(const SceneRecord& record) {
    if (record.scan_hash != name_) {
      name_ = record.scan_hash;
      volume_ = name_ == nothing ? nullptr : make_scan(name_);
    }
    if (volume_) {
      return snapshot_of(record, volume_);
    }
    const modes::Scene scene = modes::scene_from_json(record.scene, "soak");
    device::Specification stylus;
    stylus.maximum_force = record.maximum_force_n;
    const auto air = std::make_shared<testdata::AnalyticSource>(testdata::make_sphere(1), 1.0);
    const PreparedScene felt{.plan = std::make_shared<const modes::Plan>(modes::make_plan(scene, air->available(), {})),
                             .source = air};
    return snapshot_of(scene, felt, stylus);
  }

 private:
  std::string name_ = nothing;
  std::shared_ptr<const io::Volume> volume_;
};

/// Through the skin to the bone, along it and out again, for as long as is asked.
std::vector<device::Waypoint> probing(double seconds) {
  const device::Vec3 places[] = {{0, 0.03, 0},          {0, 0.023, 0}, {0.012, 0.017, 0.004}, {0, 0.012, 0},
                                 {0.008, 0.011, 0.004}, {0, 0.02, 0},  {0.02, 0.022, 0.01}};
  std::vector<device::Waypoint> path;
  const auto count = static_cast<std::size_t>(seconds / 0.7) + 1;
  for (std::size_t n = 0; n < count; ++n) {
    path.push_back({.time = 0.7 * static_cast<double>(n), .position = places[n % std::size(places)]});
  }
  return path;
}

/// Checks the ticks themselves.
class Judge {
 public:
  Judge(double force_limit_n, double slew_n_per_s, SoakResult& result)
      : force_limit_n_(force_limit_n), slew_n_per_s_(slew_n_per_s), result_(result) {}
  void look_at(const Recording& part) {
    for (const TickRecord& tick : part.ticks) look_at(tick);
    for (const Gap& gap : part.gaps) result_.lost += gap.ticks;
  }

 private:
  void look_at(const TickRecord& tick) {
    const glm::dvec3 sent(tick.sent_n[0], tick.sent_n[1], tick.sent_n[2]);
    const double force = glm::length(sent);
    ++result_.ticks;
    deadlines_ += 1 + tick.missed;
    // Deadlines are counted by the tick's time; a difference means deadlines that are not accounted for.
    const auto told = static_cast<std::uint64_t>(std::llround(tick.time_s * rate_hz)) + 1;
    result_.unaccounted += told - deadlines_;
    deadlines_ = told;
    result_.missed += tick.missed;
    result_.not_finite += std::isfinite(force) ? 0 : 1;
    // A fall to zero when the stylus is lost does not count as a step: the device is gone.
    const double most_change = slew_n_per_s_ * std::max(tick.dt_s, 1e-3) + force_limit_n_ * fall_share(tick);
    const bool fell = force < 1e-12;
    result_.over_limit += force > force_limit_n_ * (1 + 1e-12) ? 1 : 0;
    result_.over_limit += !fell && glm::length(sent - last_n_) > most_change * (1 + 1e-9) ? 1 : 0;
    result_.faulty_ticks += fault_of(tick) != device::Fault::none ? 1 : 0;
    result_.largest_n = std::max(result_.largest_n, force);
    last_n_ = sent;
  }
  /// The ramps' own change: the whole force within SafetyLimits::fall_time at the fastest.
  static double fall_share(const TickRecord& tick) {
    return std::max(tick.dt_s, 1e-3) / device::SafetyLimits{}.fall_time;
  }

 public:
  double rate_hz = 1000;

 private:
  double force_limit_n_, slew_n_per_s_;
  SoakResult& result_;
  std::uint64_t deadlines_ = 0;
  glm::dvec3 last_n_{0};
};

/// The session, its input and its recording.
class Probing {
 public:
  explicit Probing(const SoakOptions& options)
      : options_(options), random_(options.seed), stylus_(make_stylus()), replayer_(Scans{}) {
    OpenStylus open(stylus_);
    specification_ = open.specification();
    const SceneRecord first = record_of(scene_names[0], nothing);
    running_.emplace(
        std::move(open),
        RunningSession::Start{.snapshot = scans_(first), .as_recorded = as_recorded(first), .recording = new_part()});
    if (options.at_clock_pace) {
      running_->start_servo();
      heart_ = std::jthread([this](const std::stop_token& stop) {
        for (; !stop.stop_requested(); std::this_thread::sleep_for(std::chrono::milliseconds(50)))
          running_->servo()->heartbeat();
      });
    }
    next_unplug_ = draw_unplug();
  }
  Probing(const Probing&) = delete;
  Probing& operator=(const Probing&) = delete;

  double now_s() const { return static_cast<double>(running_->ring().written()) / options_.rate_hz; }

  /// Goes on to a time, with whatever is unplugged on the way.
  void go_on_to(double time_s) {
    while (next_unplug_ < time_s) {
      pass_until(next_unplug_);
      unplug();
      next_unplug_ = now_s() + draw_unplug();
    }
    pass_until(time_s);
  }
  void publish(const char* scene, const char* scan) {
    const SceneRecord record = record_of(scene, scan);
    running_->publish(scans_(record), as_recorded(record));
    ++result.scenes;
  }
  /// Ends a cycle: no scan, the part closed, everything that was left freed; then replays the part.
  void end_cycle(Judge& judge) {
    publish(scene_names[0], nothing);
    pass_until(now_s() + rest_s);
    running_->session().collect();
    const std::filesystem::path file = part_file_;
    const RecorderStatus status = running_->stop_recording().value();
    if (status.stopped) throw Refusal(status.why);
    result.points.push_back({now_s(), live_heap_bytes(), resident_bytes()});
    running_->record_to(new_part());
    {
      const Recording part = read_recording(file);
      judge.look_at(part);
      replayer_.feed(part);
    }
    std::filesystem::remove(file);
  }
  void finish(Judge& judge) {
    heart_ = {};
    running_->end();
    const std::filesystem::path file = part_file_;
    const Recording part = read_recording(file);
    judge.look_at(part);
    replayer_.feed(part);
    std::filesystem::remove(file);
    result.replay = replayer_.result();
  }

  SoakResult result;

 private:
  std::shared_ptr<device::SimulatedStylus> make_stylus() const {
    device::SimulatedDevice model;
    model.rate = options_.rate_hz;
    model.hand.tremor_seed = options_.seed;
    auto stylus = std::make_shared<device::SimulatedStylus>(model);
    stylus->follow(probing(2 * options_.seconds_of_scan + 10));
    return stylus;
  }
  SceneRecord record_of(const char* scene, const char* scan) {
    return {.epoch = next_epoch_++,
            .scene = modes::to_json(modes::load_scene(scene)),
            .scan_hash = scan,
            .half_extent_m = specification_.workspace_half_extent,
            .maximum_force_n = specification_.maximum_force};
  }
  static AsRecorded as_recorded(const SceneRecord& record) {
    return [record](std::uint32_t) { return RecordedScene{record, {}}; };
  }
  RecordingTo new_part() {
    part_file_ = options_.folder / fmt::format("part-{:04}.h5", parts_++);
    return {.file = part_file_, .header = {.device = "simulated", .rate_hz = options_.rate_hz}, .options = {}};
  }
  double draw_unplug() {
    return std::exponential_distribution<double>(1 / options_.seconds_between_unplugs)(random_) + 1;
  }
  /// Half a second without a device, then plugged in again and armed by the user.
  void unplug() {
    stylus_->inject(device::SimulatedFault::unplugged);
    pass_until(now_s() + 0.3);
    wait_for_stylus(running_->change_stylus(nullptr, {.name = "none", .force_axes = 3, .maximum_force = 0}));
    running_->session().collect();
    stylus_->inject(device::SimulatedFault::none);
    wait_for_stylus(running_->change_stylus(stylus_, specification_));
    running_->session().clear_fault();
    running_->session().arm();
    ++result.unplugs;
  }
  void wait_for_stylus(std::uint32_t epoch) {
    while (!running_->session().holds_stylus(epoch)) pass_until(now_s() + 0.01);
  }
  void pass_until(double time_s) {
    const auto end = static_cast<std::uint64_t>(std::llround(time_s * options_.rate_hz));
    while (running_->ring().written() < end) {
      if (running_->servo() != nullptr) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
      } else {
        if (running_->ring().written() % 256 == 0) running_->recorder()->wait_for_room();
        running_->session().tick();
      }
    }
  }

  SoakOptions options_;
  std::mt19937_64 random_;
  std::shared_ptr<device::SimulatedStylus> stylus_;
  device::Specification specification_;
  Scans scans_;
  Replayer replayer_;
  std::filesystem::path part_file_;
  int parts_ = 0;
  std::uint32_t next_epoch_ = 0;
  double next_unplug_ = 0;
  std::optional<RunningSession> running_;
  std::jthread heart_;  // last: it ends before what it beats for
};

/// The points after warming up: in the first third, memory is filled once.
std::span<const SoakPoint> warm(const std::vector<SoakPoint>& points) {
  return std::span(points).subspan(points.size() / 3);
}

}  // namespace

std::uint64_t SoakResult::heap_spread() const {
  const auto points_now = warm(points);
  const auto [least, most] = std::minmax_element(
      points_now.begin(), points_now.end(), [](const auto& a, const auto& b) { return a.live_bytes < b.live_bytes; });
  return points_now.empty() ? 0 : most->live_bytes - least->live_bytes;
}

double SoakResult::resident_slope() const {
  const auto points_now = warm(points);
  double count = 0, t = 0, r = 0, tt = 0, tr = 0;
  for (const SoakPoint& point : points_now) {
    const double hours = point.time_s / 3600;
    const double bytes = static_cast<double>(point.resident_bytes);
    count += 1, t += hours, r += bytes, tt += hours * hours, tr += hours * bytes;
  }
  const double spread = count * tt - t * t;
  return spread > 0 ? (count * tr - t * r) / spread : 0;
}

SoakResult soak(const SoakOptions& options) {
  Probing probing(options);
  // Reserved in advance, so that the results do not count as growth.
  probing.result.points.reserve(static_cast<std::size_t>(60 * options.minutes / options.seconds_of_scan) + 16);
  const modes::Limits limits;
  Judge judge(limits.force_n, limits.slew_n_per_ms * 1e3, probing.result);
  judge.rate_hz = options.rate_hz;
  const double end_s = 60 * options.minutes;
  const int scenes_of_scan = static_cast<int>(std::ceil(options.seconds_of_scan / options.seconds_of_scene));
  for (int scene = 0; probing.now_s() < end_s;) {
    for (const char* scan : scan_names) {
      ++probing.result.scans;
      for (int n = 0; n < scenes_of_scan; ++n) {
        probing.publish(scene_names[scene++ % std::size(scene_names)], scan);
        probing.go_on_to(probing.now_s() + options.seconds_of_scene);
      }
    }
    probing.end_cycle(judge);
    options.progress(std::min(1.0, probing.now_s() / end_s));
  }
  probing.finish(judge);
  return std::move(probing.result);
}

}  // namespace palpate::plugin
