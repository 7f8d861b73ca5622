// The whole-volume gradient against OpenCV's separable filters, an independent implementation.
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>
#include <opencv2/imgproc.hpp>

#include "io/fields/gradient.h"
#include "testdata/scan.h"

namespace palpate::io {
namespace {

/// Weights of a Gaussian (mm), cut off as the kernel's are, and the same times the offset in mm.
struct LineKernel {
  cv::Mat smooth;
  cv::Mat slope;
};

LineKernel make_kernel(double scale, double spacing, int radius) {
  LineKernel kernel{cv::Mat(2 * radius + 1, 1, CV_64F), cv::Mat(2 * radius + 1, 1, CV_64F)};
  double sum = 0;
  double second = 0;
  for (int n = -radius; n <= radius; ++n) {
    const double mm = n * spacing;
    const double weight = std::exp(-0.5 * mm * mm / (scale * scale));
    kernel.smooth.at<double>(n + radius) = weight;
    kernel.slope.at<double>(n + radius) = weight * mm;
    sum += weight;
    second += weight * mm * mm;
  }
  kernel.smooth /= sum;
  kernel.slope /= second;
  return kernel;
}

TEST(GradientAndOpenCV, AgreeOnCompleteNeighborhoods) {
  testdata::Grid grid;
  grid.size = {52, 47, 40};
  grid.spacing = {0.7, 0.8, 1.1};
  const auto volume = std::make_shared<const Volume>(
      testdata::scan(testdata::make_sphere(13), testdata::make_geometry(grid), {.noise = 60}));
  constexpr double scale = 1.5;
  const GradientKernel kernel(volume, scale);
  const glm::ivec3 reach = kernel.radius();
  const LineKernel x = make_kernel(scale, 0.7, reach.x);
  const LineKernel y = make_kernel(scale, 0.8, reach.y);
  const LineKernel z = make_kernel(scale, 1.1, reach.z);
  const glm::ivec3 size = volume->geometry.dimensions;

  // In each slice by OpenCV; across the slices one more kernel, on images of one row a slice.
  cv::Mat smooth_smooth(size.z, size.x * size.y, CV_64F);
  cv::Mat slope_smooth = smooth_smooth.clone();
  cv::Mat smooth_slope = smooth_smooth.clone();
  for (int k = 0; k < size.z; ++k) {
    cv::Mat slice(size.y, size.x, CV_64F);
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) slice.at<double>(j, i) = volume->value_at(i, j, k);
    }
    cv::Mat filtered;
    cv::sepFilter2D(slice, filtered, CV_64F, x.smooth, y.smooth);
    filtered.reshape(1, 1).copyTo(smooth_smooth.row(k));
    cv::sepFilter2D(slice, filtered, CV_64F, x.slope, y.smooth);
    filtered.reshape(1, 1).copyTo(slope_smooth.row(k));
    cv::sepFilter2D(slice, filtered, CV_64F, x.smooth, y.slope);
    filtered.reshape(1, 1).copyTo(smooth_slope.row(k));
  }
  const cv::Mat itself = cv::Mat::ones(1, 1, CV_64F);
  cv::Mat gx;
  cv::Mat gy;
  cv::Mat gz;
  cv::sepFilter2D(slope_smooth, gx, CV_64F, itself, z.smooth);
  cv::sepFilter2D(smooth_slope, gy, CV_64F, itself, z.smooth);
  cv::sepFilter2D(smooth_smooth, gz, CV_64F, itself, z.slope);

  const auto gradients = kernel.whole();
  double largest = 0;
  for (int k = reach.z; k < size.z - reach.z; ++k) {
    for (int j = reach.y; j < size.y - reach.y; ++j) {
      for (int i = reach.x; i < size.x - reach.x; ++i) {
        const int column = j * size.x + i;
        const Vec3 expected(gx.at<double>(k, column), gy.at<double>(k, column), gz.at<double>(k, column));
        ASSERT_LT(glm::length(Vec3(gradients[volume->offset(i, j, k)]) - expected), 1e-5 * 1040 / scale);
        largest = std::max(largest, glm::length(expected));
      }
    }
  }
  EXPECT_GT(largest, 100);
}

}  // namespace
}  // namespace palpate::io
