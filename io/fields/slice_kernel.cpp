#include "io/fields/slice_kernel.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <map>
#include <stdexcept>
#include <string>
#include <utility>

#include "io/messages.h"
#include "io/quantile.h"

namespace palpate::io::internal {
namespace {

/// Weights of a Gaussian whose middle lies at -shift mm, over voxels of a row.
Taps make_taps(double scale, double spacing, double shift) {
  const int middle = static_cast<int>(std::lround(-shift / spacing));
  const int radius = static_cast<int>(std::ceil(cut_off * scale / spacing));
  Taps taps;
  for (int n = 0; n <= 2 * radius; ++n) {
    const int offset = middle + (n % 2 == 1 ? -(n + 1) / 2 : n / 2);
    const double mm = offset * spacing;
    const double from_middle = (mm + shift) / scale;
    const double weight = std::exp(-0.5 * from_middle * from_middle);
    taps.push_back(
        {offset, {static_cast<float>(weight), static_cast<float>(weight * mm), static_cast<float>(weight * mm * mm)}});
  }
  return taps;
}

/// Half the distance between the neighbors: the part of an integral over uneven slices that a slice represents. A
/// missing slice belongs to none, so each side counts for at most the usual distance.
double thickness_of(const std::vector<double>& heights, std::size_t k, double usual) {
  const double below = k > 0 ? heights[k] - heights[k - 1] : usual;
  const double above = k + 1 < heights.size() ? heights[k + 1] - heights[k] : usual;
  return 0.5 * (std::min(below, 1.5 * usual) + std::min(above, 1.5 * usual)) / usual;
}

double median_step(const std::vector<double>& heights, double otherwise) {
  std::vector<double> steps;
  for (std::size_t k = 1; k < heights.size(); ++k) {
    steps.push_back(heights[k] - heights[k - 1]);
  }
  return steps.empty() ? otherwise : quantile(std::move(steps), 0.5);
}

class Builder {
 public:
  Builder(const Geometry& geometry, double scale) : geometry_(geometry), scale_(scale) {
    const Vec3 normal = glm::normalize(glm::cross(geometry.direction_i, geometry.direction_j));
    const glm::dmat3 basis(geometry.direction_i, geometry.direction_j, normal);
    from_patient_ = glm::inverse(basis);
    kernel_.to_patient = glm::transpose(from_patient_);
    for (const Vec3& position : geometry.slice_positions) {
      heights_.push_back((from_patient_ * position).z);
    }
    usual_step_ = median_step(heights_, std::abs((from_patient_ * geometry.step).z));
  }

  SliceKernel build() {
    const int slices = static_cast<int>(heights_.size());
    kernel_.of_slice.resize(heights_.size());
    add_taps(0, 0);
    for (int k = 0; k < slices; ++k) {
      add_contribution(k, k);
      for (int n = 1; n < slices; ++n) {
        const bool below = k - n >= 0 && within_reach(k, k - n);
        const bool above = k + n < slices && within_reach(k, k + n);
        if (below) add_contribution(k, k - n);
        if (above) add_contribution(k, k + n);
        if (!below && !above) break;
      }
    }
    pair_contributions();
    for (const Taps& taps : kernel_.taps_i) grow(kernel_.radius.x, taps);
    for (const Taps& taps : kernel_.taps_j) grow(kernel_.radius.y, taps);
    return std::move(kernel_);
  }

 private:
  bool within_reach(int k, int other) const {
    // The nearest slices always count, however thick: without them there is no slope along the normal.
    return std::abs(other - k) == 1 || std::abs(offset(k, other).z) <= cut_off * scale_ + 1e-6 * usual_step_;
  }

  Vec3 offset(int k, int other) const {
    const auto from = static_cast<std::size_t>(k);
    const auto to = static_cast<std::size_t>(other);
    // The same bits for the same number of steps, up and down, or even data would not cancel to 0.
    const Vec3 patient = geometry_.uniform ? static_cast<double>(other - k) * geometry_.step
                                           : geometry_.slice_positions[to] - geometry_.slice_positions[from];
    return from_patient_ * patient;
  }

  void add_contribution(int k, int other) {
    const Vec3 mm = offset(k, other);
    Contribution c;
    c.slice = other;
    const double weight = std::exp(-0.5 * (mm.z / scale_) * (mm.z / scale_));
    const double thickness =
        geometry_.uniform ? 1 : thickness_of(heights_, static_cast<std::size_t>(other), usual_step_);
    c.weight = static_cast<float>(weight * thickness);
    const double tolerance = 1e-6;  // mm: positions in a file are rounded; a shift this small is none
    const bool shifted = std::abs(mm.x) > tolerance || std::abs(mm.y) > tolerance;
    for (int axis = 0; axis < 3; ++axis) {
      c.offset[axis] = shifted || axis == 2 ? static_cast<float>(mm[axis]) : 0.0F;
    }
    if (shifted) {
      kernel_.straight = false;
      c.taps = shifted_taps(other - k, mm);
    }
    kernel_.radius.z = std::max(kernel_.radius.z, std::abs(other - k));
    kernel_.of_slice[static_cast<std::size_t>(k)].push_back(c);
  }

  void pair_contributions() {
    for (auto& contributions : kernel_.of_slice) {
      for (std::size_t n = 1; n + 1 < contributions.size(); ++n) {
        Contribution& first = contributions[n];
        const Contribution& second = contributions[n + 1];
        first.paired = kernel_.straight && first.weight == second.weight && first.offset[2] == -second.offset[2];
        n += first.paired ? 1 : 0;
      }
    }
  }

  int shifted_taps(int steps, const Vec3& mm) {
    if (const auto known = taps_of_steps_.find(steps); geometry_.uniform && known != taps_of_steps_.end()) {
      return known->second;
    }
    add_taps(mm.x, mm.y);
    const int taps = static_cast<int>(kernel_.taps_i.size()) - 1;
    taps_of_steps_[steps] = taps;
    return taps;
  }

  void add_taps(double shift_i, double shift_j) {
    kernel_.taps_i.push_back(make_taps(scale_, geometry_.spacing_i, shift_i));
    kernel_.taps_j.push_back(make_taps(scale_, geometry_.spacing_j, shift_j));
  }

  static void grow(int& radius, const Taps& taps) {
    for (const Tap& tap : taps) {
      radius = std::max(radius, std::abs(tap.offset));
    }
  }

  const Geometry& geometry_;
  double scale_;
  double usual_step_ = 1;
  glm::dmat3 from_patient_;
  std::vector<double> heights_;
  std::map<int, int> taps_of_steps_;
  SliceKernel kernel_;
};

}  // namespace

SliceKernel make_slice_kernel(const Geometry& geometry, double scale_mm) {
  if (!(scale_mm > 0)) {
    throw InvalidInput(say("scale-of-the-gradient"));
  }
  const double finest = std::min(geometry.spacing_i, geometry.spacing_j);
  const auto too_large = [&] {
    return InvalidInput(say("gradient-scale-too-large", std::to_string(scale_mm), largest_radius));
  };
  if (cut_off * scale_mm / finest > largest_radius - 1) {
    throw too_large();
  }
  SliceKernel kernel = Builder(geometry, scale_mm).build();
  if (std::max({kernel.radius.x, kernel.radius.y, kernel.radius.z}) > largest_radius) {
    throw too_large();
  }
  return kernel;
}

}  // namespace palpate::io::internal
