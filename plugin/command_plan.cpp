#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <glm/common.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "palpate/device/simulated_stylus.h"
#include "palpate/io/volume_fields.h"
#include "palpate/modes/plan.h"
#include "palpate/modes/reach.h"
#include "palpate/modes/scene_json.h"
#include "palpate/plugin/command.h"
#include "palpate/plugin/scan.h"
#include "palpate/plugin/series_option.h"
#include "palpate/solver/chain.h"

namespace palpate::plugin {
namespace {

using Json = nlohmann::ordered_json;

struct PlanOptions {
  SeriesOption series;
  std::string scene;
  bool json = false;
};

/// Mean time of one sample of a field, ns, over points from the scan's one corner to the other.
double sample_ns(const io::VolumeFields& fields, io::FieldSet field, const Box& box) {
  constexpr int points = 2000;
  double sum = 0;  // so that nothing is optimised away
  const auto start = std::chrono::steady_clock::now();
  for (int i = 0; i < points; ++i) {
    const io::Sample sample = fields.sample(glm::mix(box.low, box.high, (i + 0.5) / points), field);
    sum += sample.value + sample.gradient.x;
  }
  const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
  return sum == sum ? time.count() / points : 0;
}

std::string size_of(std::size_t bytes) {
  return fmt::format("{:.1f} MiB", static_cast<double>(bytes) / (1024 * 1024));
}

/// What leaving out the exact solver saves.
void measure_left_out_solver(std::vector<modes::LeftOut>& left_out) {
  for (modes::LeftOut& entry : left_out) {
    if (entry.what == "exact solver") {
      const std::size_t with = solver::Chain().memory_bytes();
      entry.saves = fmt::format("{:.1f} KiB of scratch memory; it would not be called",
                                static_cast<double>(with - solver::Chain({.exact = false}).memory_bytes()) / 1024);
    }
  }
}

/// Says in measured numbers what leaving out a field of this scan saves.
void measure_left_out_fields(const std::shared_ptr<const io::Volume>& volume, double scale_mm,
                             std::vector<modes::LeftOut>& left_out) {
  for (modes::LeftOut& entry : left_out) {
    if (entry.field != io::FieldSet::none) {
      const io::VolumeFields fields(volume, entry.field, scale_mm);
      entry.saves = fmt::format("{:.2f} us a sub-step, {} of memory",
                                sample_ns(fields, entry.field, bounding_box(volume->geometry)) * 1e-3,
                                size_of(fields.memory_bytes()));
    }
  }
}

std::vector<std::string> mode_names(const modes::Plan& plan, const modes::Scene& scene) {
  std::vector<std::string> names;
  for (const modes::ActiveMode& mode : plan.modes) {
    const std::string& name = scene.modes[mode.scene_index].name;
    names.push_back(std::string(mode.type->name) + (name.empty() ? "" : " \"" + name + "\""));
  }
  return names;
}

std::vector<std::string> solver_names(const modes::SolverSwitches& solvers) {
  std::vector<std::string> names;
  for (const auto& [on, name] :
       {std::pair{solvers.analytical, "analytical"}, {solvers.exact, "exact"}, {solvers.descent, "descent"}}) {
    if (on) names.emplace_back(name);
  }
  return names;
}

void print_text(const Json& json) {
  const auto line = [&json](const char* key) {
    std::string text;
    for (const auto& item : json[key]) text += (text.empty() ? "" : ", ") + item.get<std::string>();
    return text.empty() ? "none" : text;
  };
  fmt::print("fields    {}\nmodes     {}\nsolvers   {}\ndevice    {}\n", line("fields"), line("modes"), line("solvers"),
             json["device"].get<std::string>());
  if (json["left_out"].empty()) return;
  fmt::print("\nleft out:\n");
  for (const auto& entry : json["left_out"]) {
    fmt::print("  {}: {}; saves {}\n", entry["what"].get<std::string>(), entry["why"].get<std::string>(),
               entry["saves"].get<std::string>());
  }
}

void run(const PlanOptions& options) {
  // The scene first: a wrong one is refused before a large scan is read.
  if (!options.scene.empty()) modes::load_scene(options.scene);
  const auto volume = std::make_shared<const io::Volume>(load_series(options.series));
  const modes::Scene scene = scene_for(options.scene, *volume);
  const device::Specification device = device::SimulatedStylus().specification();
  const auto plan = plan_for(scene, *volume, device.workspace_half_extent);

  std::vector<modes::LeftOut> left_out = plan->left_out;
  measure_left_out_fields(volume, scene.gradient_scale_mm.value_or(io::default_gradient_scale_mm(volume->geometry)),
                          left_out);
  measure_left_out_solver(left_out);
  for (const auto& [first, last] :
       modes::slices_out_of_reach(volume->geometry, plan->workspace, device.workspace_half_extent)) {
    left_out.push_back({fmt::format("slices {}-{}", first, last), "outside the workspace",
                        "every field there: it is computed where the proxy is, and it never gets there"});
  }

  Json json{{"fields", modes::names_of(plan->fields)},
            {"modes", mode_names(*plan, scene)},
            {"solvers", solver_names(plan->solvers)},
            {"device", device.name},
            {"left_out", Json::array()}};
  for (const modes::LeftOut& entry : left_out) {
    json["left_out"].push_back({{"what", entry.what}, {"why", entry.why}, {"saves", entry.saves}});
  }
  if (options.json) {
    fmt::print("{}\n", json.dump());
  } else {
    print_text(json);
  }
}

}  // namespace

void add_plan(CLI::App& program) {
  auto options = std::make_shared<PlanOptions>();
  CLI::App* command = program.add_subcommand(
      "plan", "What a scene needs on a scan: fields, modes, solvers and device; what is left out, and why.");
  add_series_option(*command, options->series);
  command->add_option("--scene", options->scene,
                      "a scene's file or the name of a starting scene (default: one that suits the modality)");
  command->add_flag("--json", options->json, "for machines");
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin
