#include "plugin/paraview/common/body_mask.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <utility>

namespace palpate::plugin {
namespace {

constexpr double solid_hu = -400;
constexpr double bridge_mm = 3;    // half of the width of what is cut between the body and what it lies on
constexpr double hanging_mm = 10;  // an ear stays

/// Joins the labels of pieces that touch from slice to slice.
class Pieces {
 public:
  int add() {
    parent_.push_back(static_cast<int>(parent_.size()));
    count_.push_back(0);
    return parent_.back();
  }
  int root(int label) {
    while (parent_[static_cast<std::size_t>(label)] != label) {
      int& above = parent_[static_cast<std::size_t>(label)];
      above = parent_[static_cast<std::size_t>(above)];
      label = above;
    }
    return label;
  }
  void join(int a, int b) {
    a = root(a);
    b = root(b);
    if (a == b) return;
    parent_[static_cast<std::size_t>(b)] = a;
    count_[static_cast<std::size_t>(a)] += count_[static_cast<std::size_t>(b)];
  }
  void count(int label) { ++count_[static_cast<std::size_t>(root(label))]; }
  int largest() {
    int best = -1;
    for (int label = 0; label < static_cast<int>(parent_.size()); ++label) {
      if (root(label) != label) continue;
      if (best < 0 || count_[static_cast<std::size_t>(label)] > count_[static_cast<std::size_t>(best)]) best = label;
    }
    return best;
  }

 private:
  std::vector<int> parent_;
  std::vector<std::int64_t> count_;
};

cv::Mat disc(double radius_mm, double pixel_mm) {
  const int radius = std::max(1, static_cast<int>(std::lround(radius_mm / pixel_mm)));
  return cv::getStructuringElement(cv::MORPH_ELLIPSE, {2 * radius + 1, 2 * radius + 1});
}

/// The pieces of all slices, linked where they are above each other; -1 if there is none.
std::vector<cv::Mat> label_pieces(const std::vector<cv::Mat>& slices, Pieces& pieces, const KeepGoing& keep_going) {
  std::vector<cv::Mat> labels;
  for (const cv::Mat& slice : slices) {
    check_wanted(keep_going);
    cv::Mat found;
    const int here = cv::connectedComponents(slice, found, 4, CV_32S);
    std::vector<int> names(static_cast<std::size_t>(here), -1);
    for (int n = 1; n < here; ++n) names[static_cast<std::size_t>(n)] = pieces.add();
    for (int row = 0; row < found.rows; ++row) {
      int* const label = found.ptr<int>(row);
      const int* const below = labels.empty() ? nullptr : labels.back().ptr<int>(row);
      for (int column = 0; column < found.cols; ++column) {
        label[column] = names[static_cast<std::size_t>(label[column])];
        if (label[column] < 0) continue;
        pieces.count(label[column]);
        if (below && below[column] >= 0) pieces.join(label[column], below[column]);
      }
    }
    labels.push_back(std::move(found));
  }
  return labels;
}

/// What cannot be reached from the picture's edge is inside, too.
void fill_holes(cv::Mat& slice) {
  cv::Mat padded;
  cv::copyMakeBorder(slice, padded, 1, 1, 1, 1, cv::BORDER_CONSTANT, cv::Scalar(0));
  cv::floodFill(padded, {0, 0}, cv::Scalar(255));
  const cv::Mat outside = padded(cv::Rect(1, 1, slice.cols, slice.rows));
  slice.setTo(1, outside == 0);
}

}  // namespace

bool BodyMask::holds(int i, int j, int k) const {
  const glm::ivec3 at(std::min(i / step.x, size.x - 1), std::min(j / step.y, size.y - 1),
                      std::min(k / step.z, size.z - 1));
  return inside[static_cast<std::size_t>(at.x) +
                static_cast<std::size_t>(size.x) *
                    (static_cast<std::size_t>(at.y) +
                     static_cast<std::size_t>(size.y) * static_cast<std::size_t>(at.z))] != 0;
}

BodyMask body_mask(const std::function<double(int, int, int)>& value_at, const glm::ivec3& voxels,
                   const glm::dvec3& spacing_mm, Rim rim, double coarse_mm, const KeepGoing& keep_going) {
  BodyMask mask;
  for (int axis = 0; axis < 3; ++axis) {
    mask.step[axis] = std::max(1, static_cast<int>(std::ceil(coarse_mm / spacing_mm[axis] - 1e-6)));
    mask.size[axis] = (voxels[axis] + mask.step[axis] - 1) / mask.step[axis];
  }
  const double pixel_mm = std::min(spacing_mm.x * mask.step.x, spacing_mm.y * mask.step.y);
  std::vector<cv::Mat> solid, apart;
  const cv::Mat bridge = disc(bridge_mm, pixel_mm);
  for (int k = 0; k < mask.size.z; ++k) {
    check_wanted(keep_going);
    cv::Mat slice(mask.size.y, mask.size.x, CV_8U);
    for (int j = 0; j < mask.size.y; ++j) {
      for (int i = 0; i < mask.size.x; ++i) {
        const double value = value_at(i * mask.step.x, j * mask.step.y, k * mask.step.z);
        slice.at<std::uint8_t>(j, i) = value > solid_hu ? 1 : 0;
      }
    }
    cv::Mat eroded;
    cv::erode(slice, eroded, bridge);
    solid.push_back(std::move(slice));
    apart.push_back(std::move(eroded));
  }
  Pieces pieces;
  const std::vector<cv::Mat> labels = label_pieces(apart, pieces, keep_going);
  const int body = pieces.largest();
  const cv::Mat one = disc(pixel_mm, pixel_mm);
  const int steps = static_cast<int>(std::lround((bridge_mm + hanging_mm) / pixel_mm));
  for (int k = 0; k < mask.size.z; ++k) {
    check_wanted(keep_going);
    const auto n = static_cast<std::size_t>(k);
    cv::Mat slice = cv::Mat::zeros(mask.size.y, mask.size.x, CV_8U);
    for (int j = 0; j < slice.rows; ++j) {
      for (int i = 0; i < slice.cols; ++i) {
        const int label = labels[n].at<int>(j, i);
        if (label >= 0 && pieces.root(label) == body) slice.at<std::uint8_t>(j, i) = 1;
      }
    }
    for (int step = 0; step < steps; ++step) {
      cv::dilate(slice, slice, one);
      slice.setTo(0, solid[n] == 0);
    }
    fill_holes(slice);
    if (rim == Rim::one_voxel) cv::dilate(slice, slice, one);
    mask.left_something = mask.left_something || cv::countNonZero((solid[n] != 0) & (slice == 0)) > 0;
    for (int j = 0; j < slice.rows; ++j) {
      mask.inside.insert(mask.inside.end(), slice.ptr<std::uint8_t>(j), slice.ptr<std::uint8_t>(j) + slice.cols);
    }
  }
  return mask;
}

double light_part(const BodyMask& body, const std::function<double(int, int, int)>& value_at) {
  constexpr double air = -950, light = -600;
  std::int64_t inside = 0, as_light = 0;
  std::size_t at = 0;
  for (int k = 0; k < body.size.z; ++k) {
    for (int j = 0; j < body.size.y; ++j) {
      for (int i = 0; i < body.size.x; ++i) {
        if (body.inside[at++] == 0) continue;
        const double value = value_at(i * body.step.x, j * body.step.y, k * body.step.z);
        ++inside;
        as_light += value > air && value < light ? 1 : 0;
      }
    }
  }
  return inside > 0 ? static_cast<double>(as_light) / static_cast<double>(inside) : 0;
}

}  // namespace palpate::plugin
