// The mean of the neighborhood, in all three directions: less noise, softer edges.
#include <fmt/format.h>

#include <cmath>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "io/fields/filters/gaussian_weights.h"
#include "io/filter.h"

namespace palpate::io {
namespace {

/// At whole steps of `spacing`, as far as it reaches.
cv::Mat weights_at_steps(double sigma_mm, double spacing_mm) {
  const int radius = static_cast<int>(std::ceil(internal::gaussian_reach * sigma_mm / spacing_mm));
  cv::Mat row(2 * radius + 1, 1, CV_32F);
  for (int n = -radius; n <= radius; ++n) {
    const double away = n * spacing_mm / sigma_mm;
    row.at<float>(n + radius) = static_cast<float>(std::exp(-0.5 * away * away));
  }
  return row / cv::sum(row)[0];
}

cv::Mat gaussian_in_slice(const cv::Mat& values, const Geometry& g, const Filter& filter) {
  cv::Mat result;
  cv::sepFilter2D(values, result, CV_32F, weights_at_steps(filter.sigma_mm, g.spacing_i),
                  weights_at_steps(filter.sigma_mm, g.spacing_j), {-1, -1}, 0, cv::BORDER_REPLICATE);
  return result;
}

}  // namespace

extern const FilterType gaussian_filter;
const FilterType gaussian_filter{
    .name = "gaussian",
    .title = "Gaussian",
    .summary = "mean of the neighborhood, in all three directions: less noise, softer edges",
    .reads_sigma_mm = true,
    .reaches_across = true,
    .in_words = [](const Filter& filter) { return fmt::format("Gaussian filter of {:.3g} mm", filter.sigma_mm); },
    .in_slice = gaussian_in_slice,
    .blur = [](const Geometry&, const Filter& filter, const Vec3&) { return filter.sigma_mm * filter.sigma_mm; }};

}  // namespace palpate::io
