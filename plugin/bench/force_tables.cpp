#include "plugin/bench/force_tables.h"

#include <fmt/format.h>

#include <algorithm>
#include <tuple>
#include <vector>

#include "io/quantile.h"

namespace palpate::plugin {
namespace {

std::string in_quotes(const std::string& text) {
  return "\"" + text + "\"";
}

/// The factor on the stated uncertainty that would cover 95 % of the errors: 1 is right, less means it is stated too
/// wide.
double needed(const KnownPlaces& known) {
  return known.ratios.empty() ? 0 : io::quantile(std::vector<double>(known.ratios.begin(), known.ratios.end()), 0.95);
}

std::string name_of(const std::vector<std::string>& boundaries, std::size_t n) {
  return n < boundaries.size() ? boundaries[n] : "nothing";
}

struct PairOfPushers {
  std::string truth, felt;
  double part = 0;  // of the row's squares
};

std::vector<PairOfPushers> pairs_of(const ForceRowResult& row) {
  std::vector<PairOfPushers> pairs;
  if (!(row.errors.squares() > 0)) return pairs;
  for (std::size_t t = 0; t < ForceErrors::pushers; ++t) {
    for (std::size_t f = 0; f < ForceErrors::pushers; ++f) {
      const double part = row.errors.squares_of(t, f) / row.errors.squares();
      if (part > 0) pairs.push_back({name_of(row.truth_boundaries, t), name_of(row.boundaries, f), part});
    }
  }
  std::ranges::stable_sort(pairs, [](const auto& a, const auto& b) { return a.part > b.part; });
  return pairs;
}

}  // namespace

std::string forces_csv(std::span<const ForceRowResult> results, std::uint64_t seed, bool with_times) {
  std::string csv =
      "group,row,seed,paths,refused,samples,rms_n,p95_n,largest_n,affected,first_contact_median_mm,"
      "first_contact_p95_mm,missed,contacts,within_known";
  csv += with_times ? ",us_a_tick,ready_s\n" : "\n";
  for (const ForceRowResult& row : results) {
    const ForceErrors& e = row.errors;
    const KnownPlaces known = e.known_of_all();
    csv += fmt::format("{},{},{},{},{},{},{:.6f},{:.3f},{:.6f},{:.6f},{:.4f},{:.4f},{},{},{:.4f}", in_quotes(row.group),
                       in_quotes(row.name), seed, row.paths, e.refused(), e.samples(), e.rms_n(), e.p95_n(),
                       e.largest_n(), e.affected(), e.first_contact_mm(0.5), e.first_contact_mm(0.95), e.missed(),
                       known.contacts, known.share());
    csv += with_times ? fmt::format(",{:.3f},{:.3f}\n", row.us_a_tick, row.ready_s) : "\n";
  }
  return csv;
}

std::string known_csv(std::span<const ForceRowResult> results, std::uint64_t seed) {
  std::string csv = "group,row,boundary,seed,contacts,unstated,within_known,needed_over_stated\n";
  for (const ForceRowResult& row : results) {
    for (std::size_t n = 0; n < row.boundaries.size(); ++n) {
      const KnownPlaces& known = row.errors.known()[n];
      if (known.contacts + known.unstated == 0) continue;
      csv +=
          fmt::format("{},{},{},{},{},{},{:.4f},{:.3f}\n", in_quotes(row.group), in_quotes(row.name),
                      in_quotes(row.boundaries[n]), seed, known.contacts, known.unstated, known.share(), needed(known));
    }
  }
  return csv;
}

std::string pairs_csv(std::span<const ForceRowResult> results, std::uint64_t seed) {
  std::string csv = "group,row,truth_pushes,felt_pushes,seed,part_of_squares\n";
  for (const ForceRowResult& row : results) {
    for (const PairOfPushers& pair : pairs_of(row)) {
      csv += fmt::format("{},{},{},{},{},{:.5f}\n", in_quotes(row.group), in_quotes(row.name), in_quotes(pair.truth),
                         in_quotes(pair.felt), seed, pair.part);
    }
  }
  return csv;
}

void print_forces(std::span<const ForceRowResult> results) {
  std::string group;
  for (const ForceRowResult& row : results) {
    if (row.group != group) {
      group = row.group;
      fmt::print("\n{:<46} {:>6} {:>7} {:>7} {:>7} {:>9} {:>8} {:>8} {:>7} {:>7} {:>8}\n", group, "paths", "RMS, N",
                 "95 %, N", "most, N", "> 0.05 N", "1st, mm", "95 %, mm", "missed", "us/tick", "ready, s");
    }
    const ForceErrors& e = row.errors;
    fmt::print("{:<46} {:>6} {:>7.3f} {:>7.3f} {:>7.2f} {:>7.1f} % {:>8.3f} {:>8.3f} {:>7} {:>7.2f} {:>8.2f}", row.name,
               row.paths, e.rms_n(), e.p95_n(), e.largest_n(), 100 * e.affected(), e.first_contact_mm(0.5),
               e.first_contact_mm(0.95), e.missed(), row.us_a_tick, row.ready_s);
    fmt::print("{}\n", e.refused() > 0 ? fmt::format("  {} paths without an answer", e.refused()) : "");
  }
}

void print_known(std::span<const ForceRowResult> results) {
  fmt::print("\nContacts whose true boundary lies within what is stated; and what 95 % of them need, over that\n\n");
  fmt::print("{:<46} {:<24} {:>9} {:>9} {:>8}\n", "row", "boundary", "contacts", "within", "needed");
  for (const ForceRowResult& row : results) {
    if (row.errors.known_of_all().contacts == 0) continue;
    const auto line = [&](const std::string& boundary, const KnownPlaces& known) {
      if (known.contacts > 0) {
        fmt::print("{:<46} {:<24} {:>9} {:>7.1f} % {:>8.2f}\n", row.name, boundary, known.contacts, 100 * known.share(),
                   needed(known));
      }
    };
    for (std::size_t n = 0; n < row.boundaries.size(); ++n) line(row.boundaries[n], row.errors.known()[n]);
    line("all", row.errors.known_of_all());
  }
}

void print_pairs(std::span<const ForceRowResult> results, const std::string& group) {
  constexpr std::size_t most = 8;
  for (const ForceRowResult& row : results) {
    if (row.group != group) continue;
    fmt::print("\nWhat makes the error of \"{}\": by what pushes in the truth, and there\n\n", row.name);
    const auto pairs = pairs_of(row);
    for (std::size_t n = 0; n < std::min(most, pairs.size()); ++n) {
      fmt::print("{:>5.1f} %  {:<12} {}\n", 100 * pairs[n].part, pairs[n].truth, pairs[n].felt);
    }
  }
}

Chart error_against_time(std::span<const ForceRowResult> results) {
  constexpr Color palette[] = {colors::black, colors::green,  colors::sky,   colors::vermilion,
                               colors::blue,  colors::orange, colors::purple};
  constexpr double floor_n = 1e-5;  // where an error of nothing is drawn
  Chart chart{.x = {.label = "time of a tick (us); a point is a row", .logarithmic = true},
              .y = {.label = "RMS of the force error (N)", .logarithmic = true}};
  for (const ForceRowResult& row : results) {
    if (row.errors.samples() == 0) continue;
    const std::string group = row.group.substr(0, row.group.find(','));  // all of them fit in a line
    if (chart.curves.empty() || chart.curves.back().label != group) {
      chart.curves.push_back({.label = group,
                              .color = palette[chart.curves.size() % std::size(palette)],
                              .style = Curve::Style::points,
                              .width = 4});
    }
    chart.curves.back().x.push_back(row.us_a_tick);
    chart.curves.back().y.push_back(std::max(row.errors.rms_n(), floor_n));
  }
  return chart;
}

}  // namespace palpate::plugin
