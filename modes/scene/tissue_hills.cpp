#include "modes/scene/tissue_hills.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <span>

namespace palpate::modes::internal {
namespace {

constexpr float valley_floor = 0.05F;  // of the lower of two hills
constexpr double prominence = 0.15, tissue_mass = 0.01;
// Where between two tissues the boundary is. Bone comes in all degrees from cancellous to cortical: its boundary is
// nearer to soft tissue, so that a sternum of 400 HU is bone beside a skull of 1000.
constexpr double usual_place = 0.5, bone_place = 0.3;
constexpr double least_soft_hu = -200;

/// Neighbors part within the valley between them, which may be wide and empty: in its middle, or nearer to what is
/// softer than bone.
void part_neighbors(std::span<const float> curve, const io::Bins& values, bool is_ct, std::vector<Hill>& hills) {
  for (std::size_t h = 1; h < hills.size(); ++h) {
    const float* left = curve.data() + hills[h - 1].top;
    const float* right = curve.data() + hills[h].top;
    const float floor = *std::min_element(left, right) + valley_floor * std::min(*left, *right);
    const auto is_floor = [=](float height) { return height <= floor; };
    const float* first = std::find_if(left, right, is_floor);
    const float* last = right;
    while (last > first && !is_floor(*last)) {
      --last;
    }
    const double place = place_between(values.middle(static_cast<int>(hills[h - 1].top)),
                                       values.middle(static_cast<int>(hills[h].top)), is_ct);
    hills[h].first = hills[h - 1].end =
        static_cast<std::size_t>((first - curve.data()) + std::lround(place * static_cast<double>(last - first)));
  }
}

}  // namespace

double place_between(double low, double high, bool is_ct) {
  const bool is_soft = low > least_soft_hu && low < least_bone_hu;
  return is_ct && is_soft && high > least_bone_hu ? bone_place : usual_place;
}

TissueHills tissue_hills(const io::LowHighHistogram& edges, BinRange range, int least_bins, double bandwidth,
                         bool is_ct) {
  cv::Mat1f both(1, range.end - range.first, 0.0F);
  // The outermost bins hold what lies beyond them: of no one value.
  for (int high = range.first; high < std::min(range.end, edges.values.count - 1); ++high) {
    for (int low = std::max(range.first, 1); low < high - least_bins; ++low) {
      const auto count = static_cast<float>(edges.at(low, high));
      both(0, low - range.first) += count;
      both(0, high - range.first) += count;
    }
  }
  const double width = edges.values.width();
  cv::Mat1f smooth;
  cv::GaussianBlur(both, smooth, cv::Size(0, 0), bandwidth / width, 0, cv::BORDER_REPLICATE);
  TissueHills found;
  const std::span<const float> curve(smooth[0], static_cast<std::size_t>(both.cols));
  found.hills = hills_of(curve, prominence, tissue_mass);
  const auto first = static_cast<std::size_t>(range.first);
  const auto reach = static_cast<std::size_t>(2 * bandwidth / width);
  part_neighbors(
      curve,
      {edges.values.middle(range.first) - 0.5 * width, edges.values.middle(range.end - 1) + 0.5 * width, both.cols},
      is_ct, found.hills);
  for (Hill& hill : found.hills) {
    // The middle of what lies near the top: the top alone is one bin of many.
    double sum = 0, weighted = 0;
    for (std::size_t bin = std::max(hill.first + reach, hill.top) - reach;
         bin < std::min(hill.end, hill.top + reach + 1); ++bin) {
      const auto count = static_cast<double>(both(0, static_cast<int>(bin)));
      sum += count;
      weighted += count * edges.values.middle(static_cast<int>(first + bin));
    }
    found.typical.push_back(sum > 0 ? weighted / sum : edges.values.middle(static_cast<int>(first + hill.top)));
    hill = {hill.first + first, hill.top + first, hill.end + first};
  }
  return found;
}

}  // namespace palpate::modes::internal
