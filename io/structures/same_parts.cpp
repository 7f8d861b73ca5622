#include "io/structures/same_parts.h"

#include <algorithm>
#include <array>
#include <cstdint>
#include <limits>
#include <map>

namespace palpate::io::internal {
namespace {

constexpr std::uint32_t no_part = std::numeric_limits<std::uint32_t>::max();

struct Labelled {
  std::vector<std::uint32_t> part;  // of each node
  std::uint32_t count = 0;
};

Labelled labelled(const glm::ivec3& size, const std::vector<char>& inside) {
  Labelled parts{.part = std::vector<std::uint32_t>(inside.size(), no_part)};
  const std::array<std::size_t, 3> wide{static_cast<std::size_t>(size.x), static_cast<std::size_t>(size.y),
                                        static_cast<std::size_t>(size.z)};
  const std::array<std::size_t, 3> step{1, wide[0], wide[0] * wide[1]};
  std::vector<std::size_t> open;
  for (std::size_t first = 0; first < inside.size(); ++first) {
    if (parts.part[first] != no_part) continue;
    const std::uint32_t own = parts.count++;
    parts.part[first] = own;
    open.assign(1, first);
    while (!open.empty()) {
      const std::size_t node = open.back();
      open.pop_back();
      const auto visit = [&](std::size_t other) {
        if (parts.part[other] != no_part || inside[other] != inside[node]) return;
        parts.part[other] = own;
        open.push_back(other);
      };
      for (std::size_t axis = 0; axis < 3; ++axis) {
        const std::size_t at = node / step.at(axis) % wide.at(axis);
        if (at > 0) visit(node - step.at(axis));
        if (at + 1 < wide.at(axis)) visit(node + step.at(axis));
      }
    }
  }
  return parts;
}

/// The partner with most nodes of each part of the first, from how many nodes each two share.
using Shared = std::map<std::pair<std::uint32_t, std::uint32_t>, std::size_t>;
std::vector<std::uint32_t> partners(const Shared& shared, std::uint32_t count, bool of_first) {
  std::vector<std::uint32_t> partner(count, no_part);
  std::vector<std::size_t> most(count, 0);
  for (const auto& [both, nodes] : shared) {
    const std::uint32_t one = of_first ? both.first : both.second, other = of_first ? both.second : both.first;
    if (nodes <= most[one]) continue;
    most[one] = nodes;
    partner[one] = other;
  }
  return partner;
}

}  // namespace

std::vector<std::size_t> nodes_of_other_parts(const glm::ivec3& size, const std::vector<char>& before,
                                              const std::vector<char>& after) {
  const Labelled old = labelled(size, before), now = labelled(size, after);
  Shared shared;
  for (std::size_t n = 0; n < before.size(); ++n) {
    if (before[n] == after[n]) ++shared[{old.part[n], now.part[n]}];
  }
  const std::vector<std::uint32_t> now_of = partners(shared, old.count, true),
                                   old_of = partners(shared, now.count, false);
  std::vector<std::size_t> others;
  for (std::size_t n = 0; n < before.size(); ++n) {
    const std::uint32_t was = old.part[n], is = now.part[n];
    const bool went = now_of[was] == no_part || old_of[now_of[was]] != was;
    const bool came = old_of[is] == no_part || now_of[old_of[is]] != is;
    if (went || came) others.push_back(n);
  }
  return others;
}

}  // namespace palpate::io::internal
