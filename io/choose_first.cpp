#include "io/choose_first.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cmath>
#include <cstdio>
#include <tuple>

namespace palpate::io {
namespace {

// Slice thicknesses that feel different; below a millimeter there is no difference.
int thinness(const Series& series) {
  const double apart = std::max(series.geometry.slice_spacing(), series.details.thickness_mm);
  const std::array steps{1.3, 2.1, 3.2, 5.2};
  return static_cast<int>(std::lower_bound(steps.begin(), steps.end(), apart) - steps.begin());
}

auto order_of(const Series& series) {
  const bool anatomy = series.modality == "CT" || series.modality == "MR";
  constexpr int few = 10;  // slices
  return std::tuple(!anatomy, series.geometry.dimensions.z < few, series.details.is_projection, thinness(series),
                    is_sharp(series.details.kernel), series.details.is_derived, series.details.is_lossy,
                    -series.geometry.dimensions.z);
}

std::string reasons(const Series& series) {
  std::array<char, 64> apart{};
  std::snprintf(apart.data(), apart.size(), "%.2f", series.geometry.slice_spacing());
  std::string why = "slices every " + std::string(apart.data()) + " mm";
  std::replace(why.begin(), why.end(), ',', '.');  // whatever the locale's decimal sign
  const std::string& kernel = series.details.kernel;
  if (!kernel.empty()) why += std::string(is_sharp(kernel) ? ", sharp" : ", soft") + " kernel " + kernel;
  return why + ", " + std::to_string(series.geometry.dimensions.z) + " slices";
}

}  // namespace

bool is_sharp(const std::string& kernel) {
  std::string name = kernel;
  for (char& c : name) c = static_cast<char>(std::toupper(static_cast<unsigned char>(c)));
  for (const char* word : {"BONE", "LUNG", "EDGE", "SHARP", "DETAIL"}) {
    if (name.find(word) != std::string::npos) return true;
  }
  const auto digit = std::find_if(name.begin(), name.end(), [](unsigned char c) { return std::isdigit(c) != 0; });
  if (digit == name.begin() || name.end() - digit < 2 || std::isdigit(static_cast<unsigned char>(digit[1])) == 0) {
    return false;
  }
  const int number = 10 * (digit[0] - '0') + (digit[1] - '0');
  const std::string letters(name.begin(), digit);
  if (letters == "FC") return (number >= 30 && number < 40) || (number >= 50 && number < 60) || number >= 80;
  return letters.size() <= 2 && number >= 60;
}

std::optional<FirstChoice> choose_first(std::span<const Series> series) {
  std::optional<FirstChoice> best;
  for (std::size_t n = 0; n < series.size(); ++n) {
    if (!series[n].usable) continue;
    if (!best || order_of(series[n]) < order_of(series[best->index])) best = FirstChoice{n, ""};
  }
  if (best) best->why = reasons(series[best->index]);
  return best;
}

}  // namespace palpate::io
