#include "modes/scene/boundary_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string_view>

#include "modes/scene/ct_tissues.h"
#include "modes/scene/number_text.h"

namespace palpate::modes {
namespace {

constexpr double least_share = 0.001;  // of a boundary's edges: less is noise

/// The sites where a boundary is met, in the order in which a hand meets them; empty where that is not known.
std::vector<std::string> sites_of(const SiteCounts& counts, bool is_bone) {
  struct Word {
    Site site;
    const char* name;
  };
  constexpr std::array soft{Word{Site::skin, "skin"}, Word{Site::lung, "lung surface"},
                            Word{Site::inner_air, "air inside the body"}, Word{Site::cloth, "foam or cloth"},
                            Word{Site::table, "table"}};
  double all = 0;
  for (const std::uint64_t count : counts) all += static_cast<double>(count);
  std::vector<std::string> names;
  for (const Word& word : soft) {
    if (!(static_cast<double>(counts[static_cast<std::size_t>(word.site)]) > least_share * all)) continue;
    const bool is_body = word.site == Site::skin || word.site == Site::lung || word.site == Site::inner_air;
    const std::string name = is_bone && is_body ? "bone at air" : word.name;
    if (std::ranges::find(names, name) == names.end()) names.push_back(name);
  }
  return names;
}

/// "Skin, lung surface and table".
std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t n = 0; n < names.size(); ++n) {
    text += (n == 0 ? "" : n + 1 == names.size() ? " and " : ", ") + names[n];
  }
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

/// Of a boundary of air to what is light too.
std::string light_name(const SiteCounts& counts) {
  const auto share_of = [&](Site site) {
    double all = 0;
    for (const std::uint64_t count : counts) all += static_cast<double>(count);
    return all > 0 ? static_cast<double>(counts[static_cast<std::size_t>(site)]) / all : 0;
  };
  std::vector<std::string> names;
  if (share_of(Site::lung) > least_share) names.emplace_back("airways in the lung");
  if (share_of(Site::inner_air) > least_share) names.emplace_back("air inside the body");
  if (share_of(Site::skin) > least_share) names.emplace_back("skin");
  if (share_of(Site::cloth) + share_of(Site::table) > least_share) names.emplace_back("foam or cloth");
  return names.empty() ? "Lung or foam" : joined(names);
}

std::string ct_name(const NamedPair& boundary) {
  const std::string_view low = ct_tissue(boundary.low), high = ct_tissue(boundary.high);
  const bool from_air = low == "air", from_lung = low == "lung or foam";
  if (!boundary.within.empty() && low == "fat" && high == "soft tissue") return "Soft tissue";
  if (!boundary.within.empty()) return "Wall in " + boundary.within;
  if (high == "metal") return "Metal";
  if (high == "bone" && low == "bone") return "Dense bone";
  if (high == "lung or foam") return light_name(boundary.sites);
  if (from_air || from_lung) {
    const std::vector<std::string> sites = sites_of(boundary.sites, high == "bone");
    if (!sites.empty()) return joined(sites);
  }
  if (high == "bone") return from_air || from_lung ? "Bone at air" : "Bone";
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

std::vector<std::string> ranked_names(std::span<const NamedPair> boundaries, const NamingOptions& options) {
  const double range = options.range;
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
  if (values.empty() || boundaries[least].low != values.front()) return names;
  names[least] = options.is_head ? "Scalp and brain surface?" : "Skin?";
  for (std::size_t b = 0; options.is_head && b < boundaries.size(); ++b) {
    if (names[b] == "Tissue 2 to 3") names[b] = "Gray and white matter?";
  }
  return names;
}

}  // namespace

std::vector<std::string> boundary_names(std::span<const NamedPair> boundaries, const NamingOptions& options) {
  const double range = options.range;
  if (!options.hounsfield) return ranked_names(boundaries, options);
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
