#include "plugin/bench/bench_subdivision.h"

#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <array>
#include <memory>
#include <string>
#include <vector>

#include "io/fresh_folder.h"
#include "plugin/bench/subdivision_study.h"
#include "plugin/report/chart.h"
#include "plugin/report/text_file.h"

namespace palpate::plugin {
namespace {

constexpr std::array speeds_mm_per_s{10.0, 50.0, 100.0, 200.0, 500.0};
constexpr std::array mosts{1, 2, 4, 8};

const char* name_of(Wall wall) {
  return wall == Wall::convex ? "convex, 25 mm" : "concave, 12 mm";
}

void write_files(const std::vector<SubdivisionRow>& rows, const std::filesystem::path& folder) {
  std::string csv = "wall,speed_mm_per_s,most_sub_steps,sub_steps,worst_deg,worst_force_n,drift_mm,tick_us\n";
  for (const SubdivisionRow& row : rows) {
    csv += fmt::format("{},{},{},{},{},{},{},{}\n", row.wall == Wall::convex ? "convex" : "concave", row.speed_mm_per_s,
                       row.most_sub_steps, row.sub_steps, row.worst_deg, row.worst_force_n, row.drift_mm, row.tick_us);
  }
  write_text(folder / "subdivision.csv", csv);
  constexpr std::array line_colors{colors::vermilion, colors::orange, colors::green, colors::sky, colors::blue};
  std::vector<Chart> panels;
  for (const Wall wall : {Wall::convex, Wall::concave}) {
    Chart chart{.title = fmt::format("Sliding on a wall: {}", name_of(wall)),
                .x = {.label = "time of a tick, median (us)", .minimum = 0.0},
                .y = {.label = "worst error of the force (N)", .logarithmic = true},
                .curves = {},
                .marks = {}};
    for (std::size_t s = 0; s < speeds_mm_per_s.size(); ++s) {
      Curve curve{.label = fmt::format("{:.0f} mm/s", speeds_mm_per_s[s]),
                  .x = {},
                  .y = {},
                  .color = line_colors[s],
                  .style = Curve::Style::points,
                  .width = 4};
      for (const SubdivisionRow& row : rows) {
        if (row.wall == wall && row.speed_mm_per_s == speeds_mm_per_s[s]) {
          curve.x.push_back(row.tick_us);
          curve.y.push_back(row.worst_force_n);
        }
      }
      chart.curves.push_back(std::move(curve));
    }
    panels.push_back(std::move(chart));
  }
  write_png(panels, folder / "subdivision.png");
}

void study(const std::filesystem::path& folder) {
  fmt::print(
      "Sliding 1.5 mm deep at k = 400 N/m, a tick a millisecond, at most so many sub-steps of 0.1 mm a tick.\n"
      "Force: against k times the depth, along the normal at the probe. Errors on exact fields, times on voxels of 1 "
      "mm.\n\n"
      "wall              speed    most  sub-steps   direction      force      drift   time of a tick\n"
      "                   mm/s                        worst deg    worst N         mm        median us\n");
  std::vector<SubdivisionRow> rows;
  for (const Wall wall : {Wall::convex, Wall::concave}) {
    for (const double speed : speeds_mm_per_s) {
      for (const int most : mosts) {
        const SubdivisionRow row = study_subdivision(wall, speed, most);
        fmt::print("{:<16} {:6.0f} {:7d} {:10.2f} {:11.3f} {:10.5f} {:10.5f} {:17.2f}\n", name_of(wall), speed, most,
                   row.sub_steps, row.worst_deg, row.worst_force_n, row.drift_mm, row.tick_us);
        rows.push_back(row);
      }
    }
  }
  if (!folder.empty()) write_files(rows, folder);
}

}  // namespace

void add_bench_subdivision(CLI::App& bench) {
  auto output = std::make_shared<std::string>();
  CLI::App* command = bench.add_subcommand(
      "subdivision", "Sub-steps of a tick: error against run time, at several speeds of the stylus.");
  command->add_option("-o,--output", *output, "also write CSV and a picture to this new or empty folder");
  command->callback([output] { io::write_all_or_none(*output, study); });
}

}  // namespace palpate::plugin
