#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "modes/scene/plan.h"
#include "modes/scene/scene_json.h"
#include "plugin/app/errors.h"
#include "plugin/app/open_scan.h"
#include "plugin/app/plan_device.h"
#include "plugin/app/plan_savings.h"
#include "plugin/app/run_session.h"
#include "plugin/cli/commands.h"
#include "plugin/options/put.h"
#include "plugin/options/series_option.h"
#include "plugin/options/stylus_option.h"
#include "plugin/session/felt_limits.h"
#include "plugin/session/prepared_scene.h"

namespace palpate::plugin {
namespace {

using Json = nlohmann::ordered_json;

struct PlanOptions {
  SeriesOption series;
  std::string scene;
  StylusChoice stylus;
  bool json = false;
};

std::vector<std::string> mode_names(const modes::Plan& plan, const modes::Scene& scene) {
  std::vector<std::string> names;
  for (const modes::ActiveMode& mode : plan.modes) {
    const std::string& name = scene.modes[mode.scene_index].name;
    names.push_back(std::string(mode.type->name) + (name.empty() ? "" : " \"" + name + "\""));
  }
  return names;
}

std::vector<std::string> solver_names(const solver::SolverSet& solvers) {
  std::vector<std::string> names;
  for (const solver::SolverType* type : solver::solver_types()) {
    if (solvers.contains(*type)) names.emplace_back(type->name);
  }
  return names;
}

void print_text(const Json& json) {
  const auto line = [&json](const char* key) {
    std::string text;
    for (const auto& item : json[key]) text += (text.empty() ? "" : ", ") + item.get<std::string>();
    return text.empty() ? "none" : text;
  };
  put("fields    {}\nmodes     {}\nsolvers   {}\ndevice    {}\n", line("fields"), line("modes"), line("solvers"),
      json["device"].get<std::string>());
  if (json["left_out"].empty()) return;
  put("\nleft out:\n");
  for (const auto& entry : json["left_out"]) {
    put("  {}: {}; saves {}\n", entry["what"].get<std::string>(), entry["why"].get<std::string>(),
        entry["saves"].get<std::string>());
  }
}

void run(const PlanOptions& options) {
  // The scene first: a wrong one is refused before a large scan is read.
  if (!options.scene.empty()) modes::load_scene(options.scene);
  const device::Specification device = make_stylus(options.stylus)->specification();
  const io::Series series = choose_series(options.series);
  const auto volume = std::make_shared<const io::Volume>(open_scan(series, options.series.frame));
  const modes::Scene asked = scene_for(options.scene, *volume);
  tell_drawn_down(asked, device);
  const modes::Scene scene = suited_to(asked, device);
  const auto plan = plan_for(scene, *volume, device.workspace_half_extent);

  Json json{{"fields", modes::names_of(plan->fields)},
            {"modes", mode_names(*plan, scene)},
            {"solvers", solver_names(plan->solvers)},
            {"device", device.name},
            {"left_out", Json::array()}};
  std::vector<Saving> savings = measure_savings(scene, *plan, volume);
  const std::vector<Saving> of_device = savings_of_device(options.stylus.device, device);
  savings.insert(savings.end(), of_device.begin(), of_device.end());
  for (const Saving& saving : savings) {
    Json entry{{"what", saving.what}, {"why", saving.why}, {"saves", saving.saves}};
    if (saving.us) entry["saves_us_a_sub_step"] = *saving.us;
    if (saving.ms) entry["saves_ms_once"] = *saving.ms;
    if (saving.bytes) entry["saves_bytes"] = *saving.bytes;
    json["left_out"].push_back(std::move(entry));
  }
  if (options.json) {
    put_json(json);
  } else {
    print_text(json);
  }
}

}  // namespace

void add_plan(CLI::App& program) {
  auto options = std::make_shared<PlanOptions>();
  CLI::App* command = program.add_subcommand(
      "plan", "Says which fields, modes, solvers and device a scene needs on a scan, what is left out, and why.");
  add_series_option(*command, options->series);
  command->add_option(
      "--scene", options->scene,
      "a scene's file or the name of a starting scene (default: one that suits the part of the body and the modality)");
  add_device_option(*command, options->stylus);
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin
