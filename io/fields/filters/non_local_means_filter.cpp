// The mean of places in the slice with similar surroundings: the slowest filter.
#include <fmt/format.h>

#include <algorithm>
#include <opencv2/core.hpp>
#include <opencv2/photo.hpp>
#include <vector>

#include "io/filter.h"

namespace palpate::io {
namespace {

cv::Mat non_local_means_in_slice(const cv::Mat& values, const Geometry&, const Filter& filter) {
  const double sigma_value = filter.sigma_value;
  double low = 0, high = 0;
  cv::minMaxLoc(values, &low, &high);
  if (!(high > low)) return values;
  // OpenCV's is for whole numbers: steps of a 64th of the noise, or coarser where the slice's values need more room.
  const double step = std::max(sigma_value / 64, (high - low) / 65535);
  cv::Mat whole, smooth, result;
  values.convertTo(whole, CV_16U, 1 / step, -low / step);
  constexpr int surroundings = 5, searched = 15;  // voxels
  cv::fastNlMeansDenoising(whole, smooth, std::vector<float>{static_cast<float>(sigma_value / step)}, surroundings,
                           searched, cv::NORM_L1);
  smooth.convertTo(result, CV_32F, step, low);
  return result;
}

}  // namespace

extern const FilterType non_local_means_filter;
const FilterType non_local_means_filter{
    .name = "non_local_means",
    .title = "Non-local means",
    .summary = "mean of places in the slice whose surroundings look alike: the slowest",
    .reads_sigma_value = true,
    .in_words =
        [](const Filter& filter) { return fmt::format("non-local means filter of {:.3g}", filter.sigma_value); },
    .in_slice = non_local_means_in_slice};

}  // namespace palpate::io
