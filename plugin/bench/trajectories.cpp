#include "plugin/bench/trajectories.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <memory>
#include <optional>
#include <string_view>

#include "modes/tick/haptic_step.h"
#include "plugin/app/errors.h"
#include "plugin/messages/messages.h"
#include "solver/chain.h"

namespace palpate::plugin {
namespace {

constexpr std::array<std::string_view, 7> column_names{"t", "x", "y", "z", "fx", "fy", "fz"};

std::vector<std::string_view> words_of(std::string_view line) {
  constexpr std::string_view between = " \t,;\r";
  std::vector<std::string_view> words;
  for (std::size_t at = line.find_first_not_of(between); at != std::string_view::npos;) {
    const std::size_t end = std::min(line.find_first_of(between, at), line.size());
    words.push_back(line.substr(at, end - at));
    at = line.find_first_not_of(between, end);
  }
  return words;
}

/// For each column of the file the index of its name; empty if it is ignored.
std::vector<std::optional<std::size_t>> columns_of(const std::string& text) {
  std::vector<std::optional<std::size_t>> columns;
  std::array<int, column_names.size()> count{};
  for (const std::string_view word : words_of(text)) {
    const auto name = std::ranges::find(column_names, word);
    if (name != column_names.end()) {
      columns.emplace_back(static_cast<std::size_t>(name - column_names.begin()));
      ++count[*columns.back()];
    } else if (word == "-") {
      columns.emplace_back(std::nullopt);
    } else {
      throw WrongUsage(say("trajectory-columns-are-wrong", text));
    }
  }
  const bool right = count.front() <= 1 && std::all_of(count.begin() + 1, count.end(), [](int n) { return n == 1; });
  if (!right) throw WrongUsage(say("trajectory-columns-are-wrong", text));
  return columns;
}

std::optional<double> number_in(std::string_view word) {
  double value = 0;
  if (word.starts_with('+')) word.remove_prefix(1);
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(value)) return std::nullopt;
  return value;
}

}  // namespace

std::vector<MeasuredSample> read_trajectory(const std::filesystem::path& file, const std::string& columns) {
  const auto wanted = columns_of(columns);
  const bool has_time = std::ranges::find(wanted, std::optional<std::size_t>(0)) != wanted.end();
  std::ifstream stream(file, std::ios::binary);
  if (!stream || std::filesystem::is_directory(file)) {
    throw InputRefused(say("cannot-open-the-trajectory", file.string()));
  }
  std::vector<MeasuredSample> samples;
  std::size_t number = 0;
  for (std::string line; std::getline(stream, line);) {
    ++number;
    const auto words = words_of(line);
    if (words.empty() || words.front().starts_with('#') || words.front().starts_with('%')) continue;
    if (words.size() != wanted.size()) {
      throw InputRefused(say("trajectory-line-has-other-columns", file.string(), fmt::format("{}", number),
                             fmt::format("{}", words.size()), columns));
    }
    std::array<double, column_names.size()> values{};
    for (std::size_t n = 0; n < words.size(); ++n) {
      const auto value = number_in(words[n]);
      if (!value) {
        constexpr std::size_t most_shown = 40;
        throw InputRefused(say("trajectory-line-holds-no-number", file.string(), fmt::format("{}", number),
                               std::string(words[n].substr(0, most_shown))));
      }
      if (wanted[n]) values[*wanted[n]] = *value;
    }
    if (has_time && !samples.empty() && !(values[0] > samples.back().time_s)) {
      throw InputRefused(say("trajectory-time-does-not-ascend", file.string(), fmt::format("{}", number),
                             fmt::format("{}", values[0])));
    }
    samples.push_back({.time_s = values[0],
                       .position_mm = {values[1], values[2], values[3]},
                       .force_n = {values[4], values[5], values[6]}});
  }
  if (samples.size() < 2) {
    throw InputRefused(say("trajectory-has-too-few-samples", file.string(), fmt::format("{}", samples.size())));
  }
  return samples;
}

ForceErrors compare_with_measured(std::span<const MeasuredSample> samples, const FeltScene& felt,
                                  double stiffness_n_per_mm) {
  modes::Plan plan = *felt.on.plan;
  plan.stiffness_n_per_m = 1000 * stiffness_n_per_mm * 1000 / plan.workspace.mm_per_m;
  solver::Chain chain({.solvers = plan.solvers});
  const auto scratch = std::make_unique<modes::StepScratch>();
  modes::Touch touch;
  FeltPath truth, rendered;
  for (const MeasuredSample& sample : samples) {
    const glm::dvec3 probe = sample.position_mm - sample.force_n / stiffness_n_per_mm;
    const modes::StepResult result =
        modes::step(plan, *felt.on.source, plan.workspace.to_device(probe), touch, chain, *scratch);
    if (result.outcome == solver::Outcome::refused || result.outcome == solver::Outcome::unsuitable) {
      throw Refusal(say("balance-not-solved", fmt::format("{:.3f}, {:.3f}, {:.3f}", probe.x, probe.y, probe.z)));
    }
    truth.force_n.emplace_back(sample.force_n);
    rendered.force_n.emplace_back(plan.workspace.direction_to_patient(result.force_n));
  }
  truth.pusher.assign(truth.force_n.size(), FeltPath::nothing);
  rendered.pusher = truth.pusher;
  ForceErrors errors;
  errors.add(truth, rendered, {});
  return errors;
}

}  // namespace palpate::plugin
