#include "io/fields/fits.h"

#include <algorithm>
#include <glm/common.hpp>

namespace palpate::io::internal {
namespace {

constexpr int lanes = 4;
constexpr std::size_t most_edges = 40000;  // fits: a few ms

/// Rows of 1 within the first columns and rows, of 0 beyond.
struct OnesWithin {
  int columns = 0;
  int rows = 0;

  void operator()(int, int j, int i, int count, float* row) const noexcept {
    for (int n = 0; n < count; ++n) {
      row[n] = j >= 0 && j < rows && i + n >= 0 && i + n < columns ? 1.0F : 0.0F;
    }
  }
};

/// Rows of 1 everywhere: the neighborhood of a voxel far from every edge.
struct OnesEverywhere {
  void operator()(int, int, int, int count, float* row) const noexcept { std::fill(row, row + count, 1.0F); }
};

bool same_kind(const std::vector<Contribution>& a, int slice_a, const std::vector<Contribution>& b, int slice_b) {
  if (a.size() != b.size()) {
    return false;
  }
  for (std::size_t n = 0; n < a.size(); ++n) {
    if (a[n].slice - slice_a != b[n].slice - slice_b || a[n].weight != b[n].weight ||
        !std::equal(a[n].offset, a[n].offset + 3, b[n].offset) || a[n].taps != b[n].taps ||
        a[n].paired != b[n].paired) {
      return false;
    }
  }
  return true;
}

/// The sums of a block, as moments.h lays them out.
template <typename LoadRow>
std::vector<float> sums_of(const BlockLayout& layout, const SliceKernel& kernel, const LoadRow& load_row) {
  std::vector<float> buffer(layout.moment_floats(2) + layout.scratch_floats(2));
  if (buffer.empty()) return buffer;  // no block is: said because GCC 14 warns of writing into an empty one
  BlockSums<2, lanes, LoadRow>(kernel, layout, load_row, buffer.data() + layout.moment_floats(2)).run(buffer.data());
  return buffer;
}

}  // namespace

// All by the same sums, over weights alone, that a block beside padding takes: the same neighborhood gets the same
// fit.
Fits::Fits(const glm::ivec3& dimensions, const SliceKernel& kernel, double scale_mm, const glm::dmat3& to_patient)
    : scale_mm_(scale_mm),
      to_patient_(to_patient),
      dimensions_(dimensions),
      radius_(kernel.radius),
      small_(glm::min(dimensions, 2 * kernel.radius + 1)) {
  for (int k = 0; k < dimensions.z; ++k) {
    const BlockLayout layout({{0, 0, k}, {1, 1, 1}}, kernel, lanes);
    const std::vector<float> all = sums_of(layout, kernel, OnesEverywhere());
    Sums sums;
    for (std::size_t n = 0; n < sums.size(); ++n) {
      sums[n] = all[n * layout.plane()];
    }
    whole_sums_.push_back(sums);
    whole_.push_back(fit_plane(sums.data(), 1, scale_mm, to_patient));
  }
  add_edges(kernel);
}

void Fits::add_edges(const SliceKernel& kernel) {
  std::vector<int> first_of_kind;
  for (int k = 0; k < dimensions_.z; ++k) {
    std::size_t kind = 0;
    while (kind < first_of_kind.size() &&
           !same_kind(kernel.of_slice[static_cast<std::size_t>(k)], k,
                      kernel.of_slice[static_cast<std::size_t>(first_of_kind[kind])], first_of_kind[kind])) {
      ++kind;
    }
    if (kind == first_of_kind.size()) {
      first_of_kind.push_back(k);
    }
    kind_of_slice_.push_back(kind);
  }
  if (first_of_kind.size() * static_cast<std::size_t>(small_.x) * static_cast<std::size_t>(small_.y) > most_edges) {
    return;
  }
  for (const int k : first_of_kind) {
    const BlockLayout layout({{0, 0, k}, {small_.x, small_.y, 1}}, kernel, lanes);
    const std::vector<float> sums = sums_of(layout, kernel, OnesWithin{small_.x, small_.y});
    for (int j = 0; j < small_.y; ++j) {
      for (int i = 0; i < small_.x; ++i) {
        edges_.push_back(fit_plane(sums.data() + layout.at(2, 0, j, 0) + i, layout.plane(), scale_mm_, to_patient_));
      }
    }
  }
}

}  // namespace palpate::io::internal
