// The median of a square of 3 or 5 voxels in the slice (the sizes that OpenCV has for floats). It removes single wrong
// voxels and keeps straight edges.
#include <fmt/format.h>

#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "io/filter.h"

namespace palpate::io {
namespace {

cv::Mat median_in_slice(const cv::Mat& values, const Geometry&, const Filter& filter) {
  cv::Mat result;
  cv::medianBlur(values, result, filter.width);
  return result;
}

/// A median rounds as much as the mean over its square does: both move a line of curvature c by c r^2 / 6, r being half
/// of the width.
double median_blur(const Geometry& g, const Filter& filter, const Vec3& direction) {
  const glm::dvec2 in_slice(glm::dot(g.direction_i, direction) * g.spacing_i,
                            glm::dot(g.direction_j, direction) * g.spacing_j);
  return filter.width * filter.width / 12.0 * glm::dot(in_slice, in_slice);
}

}  // namespace

extern const FilterType median_filter;
const FilterType median_filter{
    .name = "median",
    .title = "Median",
    .summary = "of a square of voxels in the slice: takes single wrong voxels away, keeps straight edges",
    .reads_width = true,
    .in_words = [](const Filter& filter) { return fmt::format("median filter of {0} x {0} voxels", filter.width); },
    .in_slice = median_in_slice,
    .blur = median_blur};

}  // namespace palpate::io
