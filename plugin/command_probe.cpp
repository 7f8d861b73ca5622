#include <fmt/format.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <filesystem>
#include <fstream>
#include <glm/common.hpp>
#include <memory>
#include <optional>

#include "palpate/device/simulated_stylus.h"
#include "palpate/modes/scene_json.h"
#include "palpate/plugin/command.h"
#include "palpate/plugin/press_path.h"
#include "palpate/plugin/recording.h"
#include "palpate/plugin/scan.h"
#include "palpate/plugin/series_option.h"
#include "palpate/plugin/session.h"
#include "palpate/plugin/session_pictures.h"
#include "palpate/plugin/summary.h"
#include "palpate/plugin/vector_text.h"
#include "palpate/testdata/fresh_folder.h"

namespace palpate::plugin {
namespace {

struct Arguments {
  SeriesOption series;
  std::string scene, device = "simulated", from, to;
  std::filesystem::path path, output = "palpate-session";
  std::uint64_t seed = 1;
  bool json = false;
};

/// Where the hand goes: the file's points, or a press on the first boundary between two points.
std::vector<PathPoint> path_for(const Arguments& arguments, const Felt& felt, const Box& box) {
  if (!arguments.path.empty()) {
    return read_path_csv(arguments.path);
  }
  // From the front towards the middle, at three quarters of the scan's height: on a head, the forehead.
  const glm::dvec3 middle{0.5 * (box.low.x + box.high.x), 0.5 * (box.low.y + box.high.y),
                          box.low.z + 0.75 * (box.high.z - box.low.z)};
  const glm::dvec3 from =
      arguments.from.empty() ? glm::dvec3(middle.x, box.low.y, middle.z) : parse_vector(arguments.from, "--from");
  const glm::dvec3 to = arguments.to.empty() ? middle : parse_vector(arguments.to, "--to");
  return make_press_path(*felt.plan, *felt.source, from, to).hand;
}

glm::dvec3 middle_of(const std::vector<PathPoint>& path) {
  glm::dvec3 low = path.front().position_mm;
  glm::dvec3 high = low;
  for (const PathPoint& point : path) {
    low = glm::min(low, point.position_mm);
    high = glm::max(high, point.position_mm);
  }
  return 0.5 * (low + high);
}

std::vector<device::Waypoint> to_device(const std::vector<PathPoint>& path, const modes::Workspace& workspace,
                                        const glm::dvec3& half_extent_m) {
  std::vector<device::Waypoint> waypoints;
  for (const PathPoint& point : path) {
    const glm::dvec3 at = workspace.to_device(point.position_mm);
    if (glm::any(glm::greaterThan(glm::abs(at), half_extent_m))) {
      throw InputRefused(fmt::format(
          "the path's point at {} s, {}, is {:.0f} mm from the workspace's centre, beyond the device's reach: set "
          "workspace.center_mm or workspace.scale in the scene",
          point.time_s, patient_coordinates(point.position_mm), 1e3 * glm::length(at)));
    }
    waypoints.push_back({.time = point.time_s, .position = at});
  }
  return waypoints;
}

Recording run_session(const Felt& felt, device::SimulatedStylus& stylus, const device::SafetyLimits& limits,
                      double duration_s) {
  Recording recording;
  Session session(felt.plan, felt.source, stylus, limits);
  const auto ticks = static_cast<std::size_t>(duration_s * stylus.specification().rate);
  recording.frames.reserve(ticks);
  const bool show_progress = isatty(STDERR_FILENO) != 0;
  for (std::size_t n = 0; n < ticks; ++n) {
    recording.frames.push_back(session.tick());
    const auto shares = session.shares();
    recording.shares.insert(recording.shares.end(), shares.begin(), shares.end());
    if (show_progress && n % 1000 == 0) {
      fmt::print(stderr, "\rprobing {:3.0f} %", 100.0 * static_cast<double>(n) / static_cast<double>(ticks));
    }
  }
  if (show_progress) {
    fmt::print(stderr, "\r             \r");
  }
  return recording;
}

void write_text(const std::filesystem::path& file, const std::string& text) {
  std::ofstream stream(file);
  stream << text;
  if (!stream.flush()) {
    throw std::runtime_error("cannot write " + file.string() + " (is the disk full?)");
  }
}

void run(const Arguments& arguments) {
  if (arguments.device != "simulated") {
    throw WrongUsage("--device: there is no device \"" + arguments.device + "\"; there are: simulated");
  }
  // Everything that can be refused is refused before anything is loaded or written.
  testdata::FreshFolder folder(arguments.output);
  const auto volume = std::make_shared<const io::Volume>(load_series(arguments.series));
  modes::Scene scene = scene_for(arguments.scene, *volume);

  device::SimulatedDevice model;
  model.hand.tremor_seed = arguments.seed;
  device::SimulatedStylus stylus(model);
  const device::Specification specification = stylus.specification();

  Felt felt = prepare(scene, volume, specification.workspace_half_extent);
  const std::vector<PathPoint> path = path_for(arguments, felt, bounding_box(volume->geometry));
  if (!scene.workspace.center_mm) {
    // The hand's middle is where the path is; the fields do not depend on it.
    scene.workspace.center_mm = middle_of(path);
    felt.plan = plan_for(scene, *volume, specification.workspace_half_extent);
  }
  stylus.follow(to_device(path, felt.plan->workspace, specification.workspace_half_extent));

  Recording recording = run_session(felt, stylus, limits_for(scene.limits, specification), path.back().time_s);
  recording.header = {.palpate_version = PALPATE_VERSION,
                      .scene = modes::to_json(scene),
                      .device = specification.name,
                      .scan_hash = hash_of(*volume),
                      .seed = static_cast<double>(arguments.seed)};
  const Summary summary = summarize(recording, *felt.plan);
  const std::string words = to_text(summary, scene, describe_scan(*volume), specification.name);
  write_recording(recording, folder.path() / "recording.h5");
  write_text(folder.path() / "summary.txt", words);
  const auto pictures =
      write_session_pictures(recording, summary, scene, *felt.plan, *felt.source, volume->unit, folder.path());
  folder.commit();

  if (arguments.json) {
    fmt::print("{}\n", to_json(summary, scene));
    return;
  }
  fmt::print("{}\nWritten to {}: recording.h5, summary.txt, {}\n", words, arguments.output.string(),
             fmt::join(pictures, ", "));
}

}  // namespace

void add_probe(CLI::App& program) {
  auto arguments = std::make_shared<Arguments>();
  CLI::App* command = program.add_subcommand(
      "probe",
      "The main job: feel a scan with a stylus, and leave its recording, a summary and pictures.\n"
      "Without --path the hand presses on the first boundary between --from and --to, slides along it, pushes\n"
      "through to the next ones and lifts off.");
  add_series_option(*command, arguments->series);
  command->add_option("--scene", arguments->scene,
                      "a scene's file or the name of a starting scene (default: one that suits the modality)");
  command->add_option("--path", arguments->path, "where the hand goes: a CSV file of time_s,x_mm,y_mm,z_mm (LPS)")
      ->check(CLI::ExistingFile);
  command->add_option("--from", arguments->from,
                      "where the press begins: x,y,z in mm (default: the front, at 3/4 of the scan's height)");
  command->add_option("--to", arguments->to, "where it is directed (default: the middle, at the same height)");
  command->add_option("--device", arguments->device, "the stylus")->capture_default_str();
  command->add_option("--seed", arguments->seed, "of the simulated hand's tremor")->capture_default_str();
  command->add_option("-o,--output", arguments->output, "folder for the results; new or empty")->capture_default_str();
  command->add_flag("--json", arguments->json, "the summary for machines");
  command->callback([arguments] { run(*arguments); });
}

}  // namespace palpate::plugin
