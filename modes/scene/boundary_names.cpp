#include "modes/scene/boundary_names.h"

#include <algorithm>
#include <string_view>

#include "modes/scene/ct_tissues.h"
#include "modes/scene/number_text.h"

namespace palpate::modes {
namespace {

std::string ct_name(const NamedPair& boundary) {
  const std::string_view low = ct_tissue(boundary.low), high = ct_tissue(boundary.high);
  const bool from_air = low == "air", from_lung = low == "lung or foam";
  if (!boundary.within.empty() && low == "fat" && high == "soft tissue") return "Soft tissue";
  if (!boundary.within.empty()) return "Wall in " + boundary.within;
  if (high == "metal") return "Metal";
  if (high == "bone" && low == "bone") return "Dense bone";
  if (high == "bone") return from_air || from_lung ? "Bone at air" : "Bone";
  if (high == "lung or foam") return "Lung or foam";
  if (from_lung) return "Lung surface";
  return from_air ? "Skin" : "Soft tissue";
}

/// Ranks of the values that occur, the darkest first.
std::vector<double> sorted_values(std::span<const NamedPair> boundaries) {
  std::vector<double> values;
  for (const NamedPair& boundary : boundaries) {
    if (!boundary.within.empty()) continue;
    values.push_back(boundary.low);
    values.push_back(boundary.high);
  }
  std::sort(values.begin(), values.end());
  values.erase(std::unique(values.begin(), values.end()), values.end());
  return values;
}

std::vector<std::string> ranked_names(std::span<const NamedPair> boundaries, double range) {
  const std::vector<double> values = sorted_values(boundaries);
  const auto rank = [&values](double value) {
    return std::to_string(1 + (std::lower_bound(values.begin(), values.end(), value) - values.begin()));
  };
  std::vector<std::string> names;
  std::size_t least = 0;
  for (std::size_t b = 0; b < boundaries.size(); ++b) {
    if (!boundaries[b].within.empty()) {
      names.push_back("Wall in " + boundaries[b].within + ", " + number_text(boundaries[b].low, range) + " to " +
                      number_text(boundaries[b].high, range));
      continue;
    }
    names.push_back("Tissue " + rank(boundaries[b].low) + " to " + rank(boundaries[b].high));
    const auto sum = [&](std::size_t n) { return boundaries[n].low + boundaries[n].high; };
    if (sum(b) < sum(least)) least = b;
  }
  if (!values.empty() && boundaries[least].low == values.front()) names[least] = "Skin?";
  return names;
}

}  // namespace

std::vector<std::string> boundary_names(std::span<const NamedPair> boundaries, bool hounsfield, double range) {
  if (!hounsfield) return ranked_names(boundaries, range);
  std::vector<std::string> plain;
  plain.reserve(boundaries.size());
  for (const NamedPair& boundary : boundaries) plain.push_back(ct_name(boundary));
  const auto shared = [](const std::vector<std::string>& names, std::size_t b) {
    return std::count(names.begin(), names.end(), names[b]) > 1;
  };
  std::vector<std::string> names = plain;
  for (std::size_t b = 0; b < names.size(); ++b) {
    if (shared(plain, b)) names[b] += ", " + number_text(boundaries[b].high, range) + " HU";
  }
  const std::vector<std::string> with_high = names;
  for (std::size_t b = 0; b < names.size(); ++b) {
    if (shared(with_high, b)) names[b] += " from " + number_text(boundaries[b].low, range);
  }
  return names;
}

std::string way_back_name(const std::string& name) {
  return name + ", from inside";
}

}  // namespace palpate::modes
