#include "palpate/io/gradient.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <stdexcept>
#include <utility>

#include "palpate/io/internal/moments.h"
#include "palpate/io/internal/parallel.h"
#include "palpate/io/internal/plane_fit.h"
#include "palpate/io/internal/row_reader.h"
#include "palpate/io/internal/slice_kernel.h"

namespace palpate::io {
namespace {

using internal::BlockLayout;
using internal::BlockSums;
using internal::PlaneFit;
using internal::RowReader;
using internal::space_sums;

constexpr int cell_lanes = 4;
/// What a few hundred additions in single precision may leave of a sum that should cancel.
constexpr double single_rounding = 3e-6;
constexpr int block_lanes = 8;

/// What a single cell may need, at the largest radius: on the stack, since the tick may not allocate.
constexpr int cell_floats = [] {
  constexpr int reach = 2 * internal::largest_radius + 2;
  constexpr int row = cell_lanes + 2 * internal::largest_radius;
  return row + reach * 3 * cell_lanes + reach * internal::plane_sums(2) * 2 * cell_lanes +
         2 * (space_sums(1) + space_sums(2)) * 2 * cell_lanes;
}();

using WholeSums = std::array<float, space_sums(2)>;

/// The sums of second order as a matrix.
template <typename SumAt>
glm::dmat3 second_order(const SumAt& sum) noexcept {
  return {sum(4), sum(5), sum(7), sum(5), sum(6), sum(8), sum(7), sum(8), sum(9)};
}

/// Rows of 1 everywhere: the neighbourhood of a voxel far from every edge.
struct EverywhereOne {
  void operator()(int, int, int, int count, float* row) const noexcept { std::fill(row, row + count, 1.0F); }
};

/// Where to cut an axis: at the kernel's reach from both ends, since only what is closer to them needs its own fits,
/// and between these into pieces of at most `longest`.
std::vector<int> cuts(int size, int reach, int longest) {
  std::vector<int> at{0};
  for (const int end : {std::min(reach, size), std::max(size - reach, 0), size}) {
    while (at.back() < end) {
      at.push_back(std::min(at.back() + longest, end));
    }
  }
  return at;
}

/// The whole volume in blocks whose sums stay in a second-level cache.
std::vector<Block> blocks_of(const glm::ivec3& size, const glm::ivec3& reach) {
  const std::vector<int> x = cuts(size.x, reach.x, 112);
  const std::vector<int> y = cuts(size.y, reach.y, 24);
  const std::vector<int> z = cuts(size.z, 0, 40);
  std::vector<Block> blocks;
  for (std::size_t k = 1; k < z.size(); ++k) {
    for (std::size_t j = 1; j < y.size(); ++j) {
      for (std::size_t i = 1; i < x.size(); ++i) {
        blocks.push_back({{x[i - 1], y[j - 1], z[k - 1]}, {x[i] - x[i - 1], y[j] - y[j - 1], z[k] - z[k - 1]}});
      }
    }
  }
  return blocks;
}

}  // namespace

struct GradientKernel::Weights {
  std::shared_ptr<const Volume> volume;
  double scale_mm = 0;
  internal::SliceKernel slices;
  glm::dmat3 to_patient{1};
  std::vector<PlaneFit> whole_neighbourhood;  ///< by slice
  std::vector<WholeSums> whole_sums;          ///< by slice: of the weights of a whole neighbourhood

  template <int Lanes, typename Stored>
  void run(const std::vector<Stored>& voxels, const BlockLayout& layout, float* scratch,
           glm::vec3* gradients) const noexcept {
    float* const sums = scratch;
    float* const weights = sums + layout.moment_floats(1);
    float* const rest = weights + layout.moment_floats(2);
    const RowReader<Stored> values(*volume, voxels, false);
    BlockSums<1, Lanes, RowReader<Stored>>(slices, layout, values, rest).run(sums);
    const bool complete = values.complete();
    if (!complete) {
      const RowReader<Stored> mask(*volume, voxels, true);
      BlockSums<2, Lanes, RowReader<Stored>>(slices, layout, mask, rest).run(weights);
    }
    for (int k = 0; k < layout.block.size.z; ++k) {
      for (int j = 0; j < layout.block.size.y; ++j) {
        const float* const row = sums + layout.at(1, 0, j, k);
        if (complete) {
          const int slice = layout.block.first.z + k;
          const PlaneFit& fit = whole_neighbourhood[static_cast<std::size_t>(slice)];
          fit_row(
              row, layout, [&](int) -> const PlaneFit& { return fit; }, gradients);
        } else {
          const float* const weight_row = weights + layout.at(2, 0, j, k);
          fit_row(
              row, layout,
              [&](int i) { return internal::fit_plane(weight_row + i, layout.plane(), scale_mm, to_patient); },
              gradients);
        }
        gradients += layout.block.size.x;
      }
    }
  }

  template <typename FitAt>
  static void fit_row(const float* sums, const BlockLayout& layout, const FitAt& fit_at,
                      glm::vec3* gradients) noexcept {
    const std::size_t stride = layout.plane();
    for (int i = 0; i < layout.block.size.x; ++i) {
      const PlaneFit& fit = fit_at(i);
      const float* const s = sums + i;
      for (int axis = 0; axis < 3; ++axis) {
        gradients[i][axis] = (fit.slope[0][axis] * s[stride] + fit.slope[1][axis] * s[2 * stride]) +
                             (fit.slope[2][axis] * s[3 * stride] + fit.constant[axis] * s[0]);
      }
    }
  }

  template <int Lanes>
  void run(const BlockLayout& layout, float* scratch, glm::vec3* gradients) const noexcept {
    std::visit([&](const auto& voxels) { run<Lanes>(voxels, layout, scratch, gradients); }, volume->voxels);
  }

  template <typename Stored>
  bool hessians(const std::vector<Stored>& voxels, const BlockLayout& layout, float* scratch,
                glm::dmat3* hessians) const noexcept {
    const RowReader<Stored> values(*volume, voxels, false);
    BlockSums<2, cell_lanes, RowReader<Stored>>(slices, layout, values, scratch + layout.moment_floats(2)).run(scratch);
    if (!values.complete()) {
      return false;
    }
    for (int k = 0; k < layout.block.size.z; ++k) {
      const int slice = layout.block.first.z + k;
      const WholeSums& whole = whole_sums[static_cast<std::size_t>(slice)];
      const double total = static_cast<double>(whole[0]);
      const auto weight = [&](std::size_t n) { return static_cast<double>(whole[n]) / total; };
      const glm::dmat3 covariance = second_order(weight);
      if (glm::determinant(covariance) <= 0) {
        return false;  // a single slice has no curvature across
      }
      const glm::dmat3 inverse = to_patient * glm::inverse(covariance);
      for (int j = 0; j < layout.block.size.y; ++j) {
        for (int i = 0; i < layout.block.size.x; ++i) {
          const float* const sums = scratch + layout.at(2, 0, j, k) + i;
          const auto sum = [&](std::size_t n) { return static_cast<double>(sums[n * layout.plane()]) / total; };
          // The second derivative of a Gaussian of covariance C is C^-1 (x x^T - C) C^-1 times it.
          const glm::dmat3 excess = second_order(sum) - sum(0) * covariance;
          const double largest =
              std::max(glm::length(excess[0]), std::max(glm::length(excess[1]), glm::length(excess[2])));
          const bool rounding_alone = largest <= single_rounding * std::abs(sum(0)) * scale_mm * scale_mm;
          *hessians++ = rounding_alone ? glm::dmat3(0) : inverse * excess * glm::transpose(inverse);
        }
      }
    }
    return true;
  }

  /// The same sums, over weights alone, that a block beside padding takes: a whole neighbourhood gets the same fit in
  /// both.
  void add_whole_neighbourhood(int slice) {
    const BlockLayout layout({{0, 0, slice}, {1, 1, 1}}, slices, cell_lanes);
    std::vector<float> buffer(layout.moment_floats(2) + layout.scratch_floats(2));
    const EverywhereOne ones;
    BlockSums<2, cell_lanes, EverywhereOne>(slices, layout, ones, buffer.data() + layout.moment_floats(2))
        .run(buffer.data());
    WholeSums sums;
    for (std::size_t n = 0; n < sums.size(); ++n) {
      sums[n] = buffer[n * layout.plane()];
    }
    whole_sums.push_back(sums);
    whole_neighbourhood.push_back(internal::fit_plane(sums.data(), 1, scale_mm, to_patient));
  }
};

double default_gradient_scale_mm(const Geometry& geometry) noexcept {
  constexpr double least_mm = 1.5;
  constexpr double in_plane_voxels = 2;
  constexpr double slice_spacings = 0.6;
  const Vec3 normal = glm::cross(geometry.direction_i, geometry.direction_j);
  // The least distance between slices counts the usual one where slices are missing.
  double between = std::abs(glm::dot(geometry.step, normal));
  for (std::size_t k = 1; k < geometry.slice_positions.size(); ++k) {
    between =
        std::min(between, std::abs(glm::dot(geometry.slice_positions[k] - geometry.slice_positions[k - 1], normal)));
  }
  return std::max(
      {least_mm, in_plane_voxels * std::max(geometry.spacing_i, geometry.spacing_j), slice_spacings * between});
}

GradientKernel::GradientKernel(std::shared_ptr<const Volume> volume, double scale_mm) {
  if (!volume) {
    throw std::invalid_argument("a gradient needs a volume");
  }
  auto weights = std::make_unique<Weights>();
  weights->slices = internal::make_slice_kernel(volume->geometry, scale_mm);
  weights->scale_mm = scale_mm;
  weights->to_patient = volume->slope * weights->slices.to_patient;
  weights->volume = std::move(volume);
  for (int k = 0; k < weights->volume->geometry.dimensions.z; ++k) {
    weights->add_whole_neighbourhood(k);
  }
  weights_ = std::move(weights);
}

GradientKernel::~GradientKernel() = default;

double GradientKernel::scale_mm() const noexcept {
  return weights_->scale_mm;
}

glm::ivec3 GradientKernel::radius() const noexcept {
  return weights_->slices.radius;
}

void GradientKernel::at_cell(const Block& cell, std::span<glm::vec3> gradients) const noexcept {
  alignas(64) std::array<float, cell_floats> scratch;
  weights_->run<cell_lanes>(BlockLayout(cell, weights_->slices, cell_lanes), scratch.data(), gradients.data());
}

bool GradientKernel::hessians_at_cell(const Block& cell, std::span<glm::dmat3> hessians) const noexcept {
  alignas(64) std::array<float, cell_floats> scratch;
  const BlockLayout layout(cell, weights_->slices, cell_lanes);
  return std::visit(
      [&](const auto& voxels) { return weights_->hessians(voxels, layout, scratch.data(), hessians.data()); },
      weights_->volume->voxels);
}

void GradientKernel::at_block(const Block& block, std::span<glm::vec3> gradients) const {
  const BlockLayout layout(block, weights_->slices, block_lanes);
  const auto scratch = std::make_unique_for_overwrite<float[]>(layout.moment_floats(1) + layout.moment_floats(2) +
                                                               layout.scratch_floats(2));
  weights_->run<block_lanes>(layout, scratch.get(), gradients.data());
}

void GradientKernel::for_each_block(const std::function<void(const Block&, std::span<const glm::vec3>)>& use,
                                    const Progress& progress, int threads) const {
  const std::vector<Block> blocks = blocks_of(weights_->volume->geometry.dimensions, radius());
  const auto one = [&](std::size_t n) {
    std::vector<glm::vec3> gradients(blocks[n].voxels());
    at_block(blocks[n], gradients);
    use(blocks[n], gradients);
  };
  internal::parallel_for(blocks.size(), one, progress, threads);
}

std::vector<glm::vec3> GradientKernel::whole(const Progress& progress, int threads) const {
  const Volume& volume = *weights_->volume;
  std::vector<glm::vec3> gradients(volume.offset(0, 0, volume.geometry.dimensions.z));
  const auto place = [&](const Block& block, std::span<const glm::vec3> part) {
    auto from = part.begin();
    for (int k = 0; k < block.size.z; ++k) {
      for (int j = 0; j < block.size.y; ++j) {
        const auto to = volume.offset(block.first.x, block.first.y + j, block.first.z + k);
        std::copy(from, from + block.size.x, gradients.begin() + static_cast<std::ptrdiff_t>(to));
        from += block.size.x;
      }
    }
  };
  for_each_block(place, progress, threads);
  return gradients;
}

}  // namespace palpate::io
