#include "modes/scene/boundary_names.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <string_view>
#include <utility>

#include "modes/scene/ct_tissues.h"
#include "modes/scene/number_text.h"

namespace palpate::modes {
namespace {

constexpr double least_share = 0.001;  // of a boundary's edges: less is noise

struct SiteWord {
  Site site;
  std::string_view word;
};
// In the order in which a hand meets them.
constexpr std::array site_words{SiteWord{Site::skin, "skin"}, SiteWord{Site::lung, "lung surface"},
                                SiteWord{Site::inner_air, "air inside the body"}, SiteWord{Site::table, "table"},
                                SiteWord{Site::cloth, "foam or cloth"}};
constexpr std::string_view bone_at_air = "bone at air";

bool is_of_body(Site site) {
  return site == Site::skin || site == Site::lung || site == Site::inner_air;
}

/// Where a boundary is met, in words; empty where that is not known.
std::vector<std::string> words_of(const SiteCounts& counts, bool is_bone) {
  double all = 0;
  for (const std::uint64_t count : counts) all += static_cast<double>(count);
  const auto is_met = [&](Site site) {
    return static_cast<double>(counts[static_cast<std::size_t>(site)]) > least_share * all;
  };
  std::vector<std::string> words;
  for (const SiteWord& one : site_words) {
    // What lies on a table is part of it.
    if (!is_met(one.site) || (one.site == Site::cloth && is_met(Site::table))) continue;
    const std::string word(is_bone && is_of_body(one.site) ? bone_at_air : one.word);
    if (std::ranges::find(words, word) == words.end()) words.push_back(word);
  }
  return words;
}

std::string lowered(std::string_view text) {
  std::string lower(text);
  std::ranges::transform(lower, lower.begin(),
                         [](char c) { return static_cast<char>(std::tolower(static_cast<unsigned char>(c))); });
  return lower;
}

std::string capitalized(std::string text) {
  text.front() = static_cast<char>(std::toupper(static_cast<unsigned char>(text.front())));
  return text;
}

/// "Skin, lung surface and table".
std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (std::size_t n = 0; n < names.size(); ++n) {
    text += (n == 0 ? "" : n + 1 == names.size() ? " and " : ", ") + names[n];
  }
  return capitalized(std::move(text));
}

/// The words of a name that joined() made; empty where it is another's.
std::vector<std::string_view> parts_of(std::string_view name) {
  std::vector<std::string_view> parts;
  while (!name.empty()) {
    const std::size_t comma = name.find(", "), last = name.find(" and ");
    const std::size_t end = std::min({comma, last, name.size()});
    parts.push_back(name.substr(0, end));
    name.remove_prefix(end == name.size() ? end : end == comma ? end + 2 : end + 5);
  }
  return parts;
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
    const std::vector<std::string> words = words_of(boundary.sites, high == "bone");
    if (!words.empty()) return joined(words);
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
    if (names[b] == "Tissue 1 to 3") names[b] = "Scalp fat or CSF?";
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

std::string name_at(const std::string& name, Site site) {
  const std::string_view back = ", from inside";
  const bool is_back = name.ends_with(back);
  const std::string whole = name.substr(0, name.size() - (is_back ? back.size() : 0));
  bool is_bone = false;
  for (const std::string_view part : parts_of(whole)) {
    const std::string lower = lowered(part);
    is_bone = is_bone || lower == bone_at_air;
    if (lower != bone_at_air && std::ranges::find(site_words, lower, &SiteWord::word) == site_words.end()) return name;
  }
  const auto word = std::ranges::find(site_words, site, &SiteWord::site);
  if (whole.empty() || word == site_words.end()) return name;
  std::string text(is_bone && is_of_body(site) ? bone_at_air : word->word);
  if (std::isupper(static_cast<unsigned char>(whole.front())) != 0) text = capitalized(std::move(text));
  return is_back ? way_back_name(text) : text;
}

std::string way_back_name(const std::string& name) {
  return name + ", from inside";
}

}  // namespace palpate::modes
