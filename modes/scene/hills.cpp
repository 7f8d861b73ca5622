#include "modes/scene/hills.h"

#include <algorithm>
#include <numeric>

namespace palpate::modes::internal {
namespace {

/// Every local maximum with the bins up to the lowest on either side.
std::vector<Hill> all_hills(std::span<const float> curve) {
  std::vector<Hill> hills;
  std::size_t first = 0, top = 0;
  bool falling = false;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    if (curve[i] < curve[i - 1]) {
      falling = true;
    } else if (curve[i] > curve[i - 1] && falling) {
      // The valley may be flat: it is cut in its middle.
      std::size_t floor = i - 1;
      while (floor > top && curve[floor - 1] == curve[i - 1]) {
        --floor;
      }
      const std::size_t cut = (floor + i) / 2;
      hills.push_back({first, top, cut});
      first = cut;
      top = i;
      falling = false;
    }
    if (curve[i] > curve[top]) {
      top = i;
    }
  }
  hills.push_back({first, top, curve.size()});
  return hills;
}

}  // namespace

std::vector<Hill> hills_of(std::span<const float> curve, double prominence, double mass) {
  if (curve.empty()) {
    return {};
  }
  std::vector<Hill> hills = all_hills(curve);
  const auto sum = [&](std::size_t first, std::size_t end) {
    return std::accumulate(curve.begin() + static_cast<std::ptrdiff_t>(first),
                           curve.begin() + static_cast<std::ptrdiff_t>(end), 0.0);
  };
  const double least = mass * sum(0, curve.size());
  // How far a hill stands out of the higher of the valleys towards its neighbors, of its own height; less than 0 for
  // one that holds too little.
  const auto standing = [&](std::size_t h) {
    const double height = curve[hills[h].top];
    double valley = 0;
    if (h > 0) valley = std::max<double>(valley, curve[hills[h].first]);
    if (h + 1 < hills.size()) valley = std::max<double>(valley, curve[hills[h].end]);
    return sum(hills[h].first, hills[h].end) < least || height <= 0 ? -1.0 : (height - valley) / height;
  };
  while (hills.size() > 1) {
    std::size_t weakest = 0;
    double least_standing = 2;
    for (std::size_t h = 0; h < hills.size(); ++h) {
      const double s = standing(h);
      // Of two that hold too little the lower one goes first.
      if (s < least_standing || (s == least_standing && curve[hills[h].top] < curve[hills[weakest].top])) {
        least_standing = s;
        weakest = h;
      }
    }
    if (least_standing >= prominence) {
      break;
    }
    // Over the higher of its valleys.
    const bool left =
        weakest > 0 && (weakest + 1 == hills.size() || curve[hills[weakest].first] >= curve[hills[weakest].end]);
    const std::size_t a = left ? weakest - 1 : weakest;
    const std::size_t top = curve[hills[a].top] >= curve[hills[a + 1].top] ? hills[a].top : hills[a + 1].top;
    hills[a] = {hills[a].first, top, hills[a + 1].end};
    hills.erase(hills.begin() + static_cast<std::ptrdiff_t>(a) + 1);
  }
  return hills;
}

}  // namespace palpate::modes::internal
