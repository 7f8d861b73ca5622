// The mean of those neighbors in the slice whose values are alike: it keeps edges above the noise.
#include <fmt/format.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "io/filter.h"

namespace palpate::io {
namespace {

cv::Mat bilateral_in_slice(const cv::Mat& values, const Geometry& g, const Filter& filter) {
  const double voxel = std::sqrt(g.spacing_i * g.spacing_j);  // OpenCV's neighborhoods are round in voxels
  cv::Mat result;
  cv::bilateralFilter(values, result, 2 * static_cast<int>(std::ceil(2 * filter.sigma_mm / voxel)) + 1,
                      filter.sigma_value, filter.sigma_mm / voxel, cv::BORDER_REPLICATE);
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
