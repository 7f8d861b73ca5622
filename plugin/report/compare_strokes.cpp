#include "plugin/report/compare_strokes.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <limits>
#include <stdexcept>

#include "plugin/messages/messages.h"
#include "plugin/recording/table_file.h"

namespace palpate::plugin {
namespace {

constexpr double step_m = 0.5e-3;    // of the hand: a tremor's 0.05 mm (root mean square) do not make a way
constexpr double most_steps = 3000;  // coupling takes the product of both

/// A place of the probe, and the mean force there.
struct Step {
  glm::dvec3 place_mm{0};
  double along_mm = 0;
  double force_n = 0;
};

/// Another step begins where the probe is farther than that from where the last one began.
std::vector<Step> steps_of(const RecordedSession& session, double step_mm) {
  std::vector<Step> steps;
  std::size_t ticks = 0;
  for (std::size_t n = 0; n < session.size(); ++n) {
    const glm::dvec3 place = session.probe_mm(n);
    if (steps.empty() || glm::distance(place, steps.back().place_mm) >= step_mm) {
      const double along = steps.empty() ? 0 : steps.back().along_mm + glm::distance(place, steps.back().place_mm);
      steps.push_back({place, along, 0});
      ticks = 0;
    }
    ++ticks;
    steps.back().force_n += (glm::length(session.sent_n(n)) - steps.back().force_n) / static_cast<double>(ticks);
  }
  return steps;
}

/// In steps as short as can be coupled.
std::vector<Step> steps_of(const RecordedSession& session) {
  const double step_mm = step_m * session.workspace(0).mm_per_m;
  std::vector<Step> steps = steps_of(session, step_mm);
  if (static_cast<double>(steps.size()) <= most_steps) return steps;
  return steps_of(session, std::max(step_mm, steps.back().along_mm / most_steps));
}

enum class From : std::uint8_t { both, first, second };

/// Which step each came from on the way of least cost, row by row: first's steps by second's.
std::vector<From> couple(const std::vector<Step>& first, const std::vector<Step>& second) {
  const std::size_t width = second.size();
  std::vector<From> from(first.size() * width);
  std::vector<double> above(width, std::numeric_limits<double>::infinity()), row(width);
  for (std::size_t i = 0; i < first.size(); ++i) {
    for (std::size_t j = 0; j < width; ++j) {
      const glm::dvec3 gap = first[i].place_mm - second[j].place_mm;
      double least = i == 0 && j == 0 ? 0 : std::numeric_limits<double>::infinity();
      // If no way costs less, as no cost of one is a number, it still leads back to the beginning.
      From best = i == 0 ? From::second : (j == 0 ? From::first : From::both);
      const auto take = [&](double cost, From way) {
        if (cost < least) {
          least = cost;
          best = way;
        }
      };
      if (i > 0 && j > 0) take(above[j - 1], From::both);
      if (i > 0) take(above[j], From::first);
      if (j > 0) take(row[j - 1], From::second);
      row[j] = least + glm::dot(gap, gap);
      from[i * width + j] = best;
    }
    std::swap(above, row);
  }
  return from;
}

}  // namespace

Comparison compare_strokes(const RecordedSession& first, const RecordedSession& second) {
  const std::vector<Step> a = steps_of(first), b = steps_of(second);
  const std::vector<From> from = couple(a, b);
  Comparison result;
  result.second_n.assign(a.size(), 0);
  result.apart_mm.assign(a.size(), 0);
  std::vector<double> coupled(a.size(), 0);
  for (std::size_t i = a.size() - 1, j = b.size() - 1;;) {
    coupled[i] += 1;
    result.second_n[i] += b[j].force_n;
    result.apart_mm[i] = std::max(result.apart_mm[i], glm::distance(a[i].place_mm, b[j].place_mm));
    if (i == 0 && j == 0) break;
    const From way = from[i * b.size() + j];
    if (way != From::second) --i;
    if (way != From::first) --j;
  }
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    result.along_mm.push_back(a[i].along_mm);
    result.first_n.push_back(a[i].force_n);
    result.second_n[i] /= coupled[i];
    const double difference = std::abs(result.second_n[i] - a[i].force_n);
    sum += difference;
    if (difference > result.largest_difference_n) {
      result.largest_difference_n = difference;
      result.largest_difference_at_mm = a[i].along_mm;
    }
    result.most_apart_mm = std::max(result.most_apart_mm, result.apart_mm[i]);
  }
  result.mean_difference_n = sum / static_cast<double>(a.size());
  return result;
}

std::vector<Chart> charts_of(const Comparison& comparison, const std::string& first, const std::string& second) {
  const auto chart = [&](const std::string& title, const std::string& label) {
    Chart made;
    made.title = title;
    made.x.label = "way along the stroke (mm)";
    made.y.label = label;
    return made;
  };
  std::vector<double> difference;
  for (std::size_t n = 0; n < comparison.along_mm.size(); ++n) {
    difference.push_back(comparison.second_n[n] - comparison.first_n[n]);
  }
  std::vector<Chart> charts{chart("Force of both", "force (N)"), chart("Force: second less first", "difference (N)"),
                            chart("Distance between the two ways", "distance (mm)")};
  charts[0].curves = {{.label = first, .x = comparison.along_mm, .y = comparison.first_n},
                      {.label = second, .x = comparison.along_mm, .y = comparison.second_n, .color = colors::orange}};
  charts[0].y.minimum = 0;
  charts[1].curves = {{.label = "", .x = comparison.along_mm, .y = difference, .color = colors::vermilion}};
  charts[2].curves = {{.label = "", .x = comparison.along_mm, .y = comparison.apart_mm, .color = colors::green}};
  charts[2].y.minimum = 0;
  charts[2].y.maximum = std::max(0.5, 1.08 * comparison.most_apart_mm);
  return charts;
}

void write_csv(const Comparison& comparison, const std::filesystem::path& file) try {
  TableFile out(file);
  out.print("along_mm,first_n,second_n,apart_mm\n");
  for (std::size_t n = 0; n < comparison.along_mm.size(); ++n) {
    out.print("{},{},{},{}\n", comparison.along_mm[n], comparison.first_n[n], comparison.second_n[n],
              comparison.apart_mm[n]);
  }
  out.close();
} catch (const std::exception& error) {
  throw Refusal(say("table-cannot-be-written", file.string(), error.what()));
}

std::string in_words(const Comparison& comparison) {
  return fmt::format(
      "Forces differ by at most {:.2f} N, {:.1f} mm along the stroke; by {:.2f} N on average. The two ways are at most "
      "{:.1f} mm apart.",
      comparison.largest_difference_n, comparison.largest_difference_at_mm, comparison.mean_difference_n,
      comparison.most_apart_mm);
}

}  // namespace palpate::plugin
