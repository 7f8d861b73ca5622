// The mean of similar neighbors in the slice: it keeps edges that are larger than the noise.
#include <fmt/format.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "io/filter.h"

namespace palpate::io {
namespace {

/// Scales the values into the range of OpenCV's tables: below 1e-7 it filters nothing, and if the range overflows a
/// float it reads beyond them. A power of two changes no digit.
double factor_for_tables(const cv::Mat& values) {
  constexpr double least = 1e-3, most = 1e30;
  double low = 0, high = 0;
  cv::minMaxLoc(values, &low, &high);
  const double range = high - low;
  return range > 0 && (range < least || range > most) ? std::exp2(-std::ilogb(range)) : 1;
}

cv::Mat bilateral_in_slice(const cv::Mat& values, const Geometry& g, const Filter& filter) {
  const double voxel = std::sqrt(g.spacing_i * g.spacing_j);  // OpenCV's neighborhoods are round in voxels
  const double factor = factor_for_tables(values);
  cv::Mat scaled = values, result;
  if (factor != 1) values.convertTo(scaled, CV_32F, factor);
  cv::bilateralFilter(scaled, result, 2 * static_cast<int>(std::ceil(2 * filter.sigma_mm / voxel)) + 1,
                      factor * filter.sigma_value, filter.sigma_mm / voxel, cv::BORDER_REPLICATE);
  if (factor != 1) result.convertTo(result, CV_32F, 1 / factor);
  return result;
}

}  // namespace

extern const FilterType bilateral_filter;
const FilterType bilateral_filter{
    .name = "bilateral",
    .title = "Bilateral",
    .summary = "mean of those neighbors in the slice whose values are alike: keeps edges above the noise",
    .reads_sigma_mm = true,
    .reads_sigma_value = true,
    .in_words =
        [](const Filter& filter) {
          return fmt::format("bilateral filter of {:.3g} mm and {:.3g}", filter.sigma_mm, filter.sigma_value);
        },
    .in_slice = bilateral_in_slice};

}  // namespace palpate::io
