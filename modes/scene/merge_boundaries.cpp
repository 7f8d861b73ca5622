#include "modes/scene/merge_boundaries.h"

#include <algorithm>
#include <functional>
#include <string>
#include <string_view>

#include "modes/scene/ct_tissues.h"

namespace palpate::modes::internal {
namespace {

// Of the way from the one tissue to the other: nearer to either, its own spread would reach the boundary.
constexpr double nearest_low = 0.25, nearest_high = 0.7;

/// Fat and soft tissue are one: what is called skin or bone lies on either.
std::string_view class_of(double hu) {
  const std::string_view tissue = ct_tissue(hu);
  return tissue == "fat" ? "soft tissue" : tissue;
}

struct Group {
  std::vector<FoundBoundary> parts;
  double least_middle = 0, most_middle = 0;  ///< where one value is well between the tissues of every part
};

double part_of_way(const FoundBoundary& boundary, const Suggestion& suggestion, double part) {
  const double low = suggestion.typical[boundary.low], high = suggestion.typical[boundary.high];
  return low + part * (high - low);
}

bool is_named_alike(const FoundBoundary& a, const FoundBoundary& b, const Suggestion& suggestion) {
  const auto low = [&](const FoundBoundary& one) { return class_of(suggestion.typical[one.low]); };
  const auto high = [&](const FoundBoundary& one) { return class_of(suggestion.typical[one.high]); };
  // Two kinds of the same tissue part from each other each in a way of its own. And thin or cancellous bone would be
  // lost where dense bone raises the level.
  const bool is_bone_in_tissue = high(a) == "bone" && low(a) == "soft tissue";
  return low(a) == low(b) && high(a) == high(b) && low(a) != high(a) && (!is_bone_in_tissue || a.high == b.high);
}

bool add_to(Group& group, const FoundBoundary& boundary, const Suggestion& suggestion) {
  const double least = std::max(group.least_middle, part_of_way(boundary, suggestion, nearest_low));
  const double most = std::min(group.most_middle, part_of_way(boundary, suggestion, nearest_high));
  if (!is_named_alike(group.parts.front(), boundary, suggestion) || least > most) return false;
  group.parts.push_back(boundary);
  group.least_middle = least;
  group.most_middle = most;
  return true;
}

/// The tissue that reaches over all those that the parts name on one side; it is added where there is more than one.
std::size_t tissue_over(const Group& group, std::size_t FoundBoundary::*side, bool is_low, Suggestion& suggestion) {
  std::vector<std::size_t> of;
  for (const FoundBoundary& part : group.parts) of.push_back(part.*side);
  std::ranges::sort(of);
  of.erase(std::unique(of.begin(), of.end()), of.end());
  if (of.size() == 1) return of.front();
  std::vector<Tissue>& tissues = suggestion.scene.tissues;
  const Tissue &first = tissues[of.front()], &last = tissues[of.back()];
  const Tissue over{.name = first.name + " to " + last.name,
                    .low = first.low,
                    .high = last.high,
                    .softness = std::min(first.softness, last.softness)};
  const auto known = std::ranges::find(tissues, over.name, &Tissue::name);
  if (known != tissues.end()) return static_cast<std::size_t>(known - tissues.begin());
  tissues.push_back(over);
  // Its value nearest to the other side: the faintest of the parts decides what the boundary's gradient has to be.
  const double nearest = suggestion.typical[is_low ? of.back() : of.front()];
  suggestion.typical.push_back(nearest);
  return tissues.size() - 1;
}

FoundBoundary merged(const Group& group, Suggestion& suggestion) {
  FoundBoundary all = group.parts.front();
  if (group.parts.size() == 1) return all;
  double share = 0, weighted = 0;
  for (const FoundBoundary& part : group.parts) {
    share += part.share;
    weighted += part.share * part.middle;
  }
  all.share = share;
  all.middle = std::clamp(weighted / share, group.least_middle, group.most_middle);
  all.low = tissue_over(group, &FoundBoundary::low, true, suggestion);
  all.high = tissue_over(group, &FoundBoundary::high, false, suggestion);
  return all;
}

}  // namespace

void merge_boundaries(std::vector<FoundBoundary>& boundaries, Suggestion& suggestion) {
  std::vector<Group> groups;
  for (const FoundBoundary& boundary : boundaries) {
    const auto takes = [&](Group& group) { return add_to(group, boundary, suggestion); };
    if (!std::ranges::any_of(groups, takes)) {
      groups.push_back({{boundary},
                        part_of_way(boundary, suggestion, nearest_low),
                        part_of_way(boundary, suggestion, nearest_high)});
    }
  }
  boundaries.clear();
  for (const Group& group : groups) boundaries.push_back(merged(group, suggestion));
  std::ranges::stable_sort(boundaries, std::greater<>(), &FoundBoundary::share);
}

}  // namespace palpate::modes::internal
