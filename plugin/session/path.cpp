#include "plugin/session/path.h"

#include <fmt/format.h>

#include <array>
#include <charconv>
#include <cmath>
#include <fstream>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "plugin/messages/messages.h"

namespace palpate::plugin {
namespace {

constexpr std::string_view header = "time_s,x_mm,y_mm,z_mm";
constexpr std::string_view header_with_buttons = "time_s,x_mm,y_mm,z_mm,buttons";
constexpr double most_buttons = 0xFFFF;

std::string_view trim(std::string_view text) {
  const auto first = text.find_first_not_of(" \t\r");
  return first == std::string_view::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

/// As many finite numbers, or false. std::from_chars: the locale's decimal comma plays no part.
bool parse(std::string_view line, std::span<double> numbers) {
  for (std::size_t n = 0; n < numbers.size(); ++n) {
    const auto comma = line.find(',');
    const bool last = n + 1 == numbers.size();
    if ((comma == std::string_view::npos) != last) {
      return false;
    }
    const std::string_view cell = trim(line.substr(0, comma));
    const char* const cell_end = cell.data() + cell.size();
    const auto [end, error] = std::from_chars(cell.data(), cell_end, numbers[n]);
    if (error != std::errc{} || end != cell_end || !std::isfinite(numbers[n])) {
      return false;
    }
    line = last ? "" : line.substr(comma + 1);
  }
  return true;
}

}  // namespace

std::vector<PathPoint> read_path_csv(const std::filesystem::path& file) {
  std::ifstream stream(file);
  if (!stream) {
    throw Refusal(say("cannot-open-the-path-file", file.string()));
  }
  std::vector<PathPoint> path;
  std::string line;
  bool with_buttons = false;
  for (int number = 1; std::getline(stream, line); ++number) {
    const std::string_view content = trim(line);
    with_buttons = with_buttons || (number == 1 && content == header_with_buttons);
    if (content.empty() || content.front() == '#' || (number == 1 && (with_buttons || content == header))) {
      continue;
    }
    std::array<double, 5> cells{};
    if (!parse(content, std::span(cells).first(with_buttons ? 5 : 4))) {
      throw Refusal(say("line-not-four-finite-numbers", file.string(), number, header));
    }
    const auto& [time_s, x_mm, y_mm, z_mm, buttons] = cells;
    if (buttons < 0 || buttons > most_buttons || buttons != std::floor(buttons)) {
      throw Refusal(say("line-buttons-is-no-bit-mask", file.string(), number, fmt::format("{}", buttons)));
    }
    if (time_s < 0 || (!path.empty() && time_s <= path.back().time_s)) {
      throw Refusal(say("line-time-s-does-not-come-after", file.string(), number, fmt::format("{}", time_s)));
    }
    path.push_back({time_s, {x_mm, y_mm, z_mm}, static_cast<std::uint32_t>(buttons)});
  }
  if (path.size() < 2) {
    throw Refusal(say("path-needs-at-least-two-points", file.string(), header));
  }
  return path;
}

}  // namespace palpate::plugin
