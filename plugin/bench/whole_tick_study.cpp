#include "plugin/bench/whole_tick_study.h"

#include <fmt/format.h>

#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/fields/volume_fields.h"
#include "plugin/bench/wall_slide.h"
#include "plugin/report/chart.h"
#include "plugin/report/summary.h"
#include "plugin/report/text_file.h"
#include "testdata/scan.h"

namespace palpate::plugin {
namespace {

struct Fields {
  std::string name;
  io::GradientMethod method = io::GradientMethod::gaussian;
  double scale_mm = 2;
};

constexpr Color palette[] = {colors::blue, colors::green, colors::vermilion, colors::purple, colors::orange};

std::vector<Fields> all_fields() {
  std::vector<Fields> fields{{"central differences", io::GradientMethod::central_differences},
                             {"cubic B-spline", io::GradientMethod::cubic}};
  for (const double scale_mm : {1.0, 1.5, 2.0, 3.0}) {
    fields.push_back({fmt::format("Gaussian, {} mm", scale_mm), io::GradientMethod::gaussian, scale_mm});
  }
  return fields;
}

}  // namespace

void run_whole_tick(const std::filesystem::path& folder) {
  fmt::print(
      "\nthe whole tick: sliding at 50 mm/s, 1.5 mm deep, on a ball of 25 mm in voxels of 1 mm with 20 HU of noise\n"
      "{:<22}{:<12}{:>16}{:>14}{:>14}{:>16}{:>9}\n",
      "gradient", "solver", "force off, rms N", "worst jump N", "worst deg", "median tick us", "capped");
  testdata::Acquisition acquisition;
  acquisition.noise = 20;
  const auto volume = std::make_shared<const io::Volume>(
      testdata::scan(phantom_of(Wall::convex), testdata::make_geometry({}), acquisition));
  std::string csv = "gradient,solver,rms_true_n,worst_force_n,worst_deg,tick_us,capped\n";
  Chart chart{.title = "The whole tick: what is off in the force",
              .x = {.label = "time of a tick, median (us)", .logarithmic = true},
              .y = {.label = "off from the truth, rms (N)", .logarithmic = true},
              .curves = {},
              .marks = {}};
  const auto types = solver::solver_types();
  for (std::size_t s = 0; s < types.size(); ++s) {
    chart.curves.push_back({.label = std::string(types[s]->name),
                            .x = {},
                            .y = {},
                            .color = palette[s % std::size(palette)],
                            .style = Curve::Style::points,
                            .width = 4});
  }
  for (const Fields& choice : all_fields()) {
    io::FieldOptions options;
    options.gradient = choice.method;
    const io::VolumeFields source(volume, io::FieldSet::value | io::FieldSet::gradient, choice.scale_mm, options);
    source.prepare({0, 0, 0}, 30);
    for (std::size_t s = 0; s < types.size(); ++s) {
      modes::Scene scene = wall_scene();
      scene.solvers = {types[s]};
      const Slide slide = slide_on(Wall::convex, source, scene, 50);
      const double tick_us = percentiles_of(slide.ticks_us).median;
      fmt::print("{:<22}{:<12}{:>16.4f}{:>14.4f}{:>14.3f}{:>16.2f}{:>9}\n", choice.name, types[s]->name,
                 slide.rms_true_n, slide.worst_force_n, slide.worst_deg, tick_us, slide.capped);
      csv += fmt::format("\"{}\",{},{},{},{},{},{}\n", choice.name, types[s]->name, slide.rms_true_n,
                         slide.worst_force_n, slide.worst_deg, tick_us, slide.capped);
      chart.curves[s].x.push_back(tick_us);
      chart.curves[s].y.push_back(slide.rms_true_n);
    }
  }
  if (!folder.empty()) {
    write_text(folder / "whole-tick.csv", csv);
    write_png(chart, folder / "whole-tick.png", 960, 480);
  }
}

}  // namespace palpate::plugin
