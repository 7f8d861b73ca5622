#include "palpate/io/gradient.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <stdexcept>
#include <type_traits>
#include <utility>

#include "palpate/io/internal/moments.h"
#include "palpate/io/internal/parallel.h"
#include "palpate/io/internal/plane_fit.h"
#include "palpate/io/internal/slice_kernel.h"

namespace palpate::io {
namespace {

using internal::BlockLayout;
using internal::BlockSums;
using internal::PlaneFit;
using internal::space_sums;

constexpr int cell_lanes = 4;
constexpr int block_lanes = 16;

/// What a single cell may need, at the largest radius: on the stack, since the tick may not allocate.
constexpr int cell_floats = [] {
  constexpr int reach = 2 * internal::largest_radius + 2;
  constexpr int row = cell_lanes + 2 * internal::largest_radius;
  return row + reach * 3 * cell_lanes + reach * internal::plane_sums(2) * 2 * cell_lanes +
         2 * (space_sums(1) + space_sums(2)) * 2 * cell_lanes;
}();

/// Reads rows of a volume as stored values, or as 1 where there is a value: 0 beyond the volume and in padding.
template <typename Stored>
class RowReader {
 public:
  RowReader(const Volume& volume, const std::vector<Stored>& voxels, bool mask)
      : volume_(volume), voxels_(voxels.data()), mask_(mask) {}

  void operator()(int slice, int j, int i, int count, float* row) const noexcept {
    const glm::ivec3 size = volume_.geometry.dimensions;
    const int first = std::clamp(-i, 0, count);
    const int last = j < 0 || j >= size.y ? first : std::clamp(size.x - i, first, count);
    std::fill(row, row + first, 0.0F);
    if (first < last) {
      copy(voxels_ + volume_.offset(i + first, j, slice), last - first, row + first);
    }
    std::fill(row + last, row + count, 0.0F);
    complete_ = complete_ && last - first == count;
  }
  /// Whether everything read so far was inside and no padding.
  bool complete() const noexcept { return complete_; }

 private:
  void copy(const Stored* stored, int count, float* row) const noexcept {
    bool any_padding = false;
    for (int n = 0; n < count; ++n) {
      const bool padding = is_padding(stored[n]);
      any_padding = any_padding || padding;
      row[n] = padding ? 0.0F : mask_ ? 1.0F : static_cast<float>(stored[n]);
    }
    complete_ = complete_ && !any_padding;
  }
  bool is_padding(Stored stored) const noexcept {
    if constexpr (std::is_floating_point_v<Stored>) {
      if (!std::isfinite(stored)) {
        return true;
      }
    }
    return volume_.padding && stored >= volume_.padding->first && stored <= volume_.padding->second;
  }

  const Volume& volume_;
  const Stored* voxels_;
  bool mask_;
  mutable bool complete_ = true;
};

/// Rows of 1 everywhere: the neighbourhood of a voxel far from every edge.
struct EverywhereOne {
  void operator()(int, int, int, int count, float* row) const noexcept { std::fill(row, row + count, 1.0F); }
};

}  // namespace

struct GradientKernel::Weights {
  std::shared_ptr<const Volume> volume;
  double scale_mm = 0;
  internal::SliceKernel slices;
  glm::dmat3 to_patient{1};
  std::vector<PlaneFit> whole_neighbourhood;  ///< by slice

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
    const std::size_t stride = layout.plane();
    for (int k = 0; k < layout.block.size.z; ++k) {
      const PlaneFit& whole_fit = whole_neighbourhood[static_cast<std::size_t>(layout.block.first.z + k)];
      for (int j = 0; j < layout.block.size.y; ++j) {
        const float* const row = sums + layout.at(1, 0, j, k);
        const float* const weight_row = weights + layout.at(2, 0, j, k);
        for (std::size_t i = 0; i < static_cast<std::size_t>(layout.block.size.x); ++i) {
          const PlaneFit& fit =
              complete ? whole_fit : internal::fit_plane(weight_row + i, stride, scale_mm, to_patient);
          *gradients++ = fit.gradient(row[i], row[stride + i], row[2 * stride + i], row[3 * stride + i]);
        }
      }
    }
  }

  template <int Lanes>
  void run(const BlockLayout& layout, float* scratch, glm::vec3* gradients) const noexcept {
    std::visit([&](const auto& voxels) { run<Lanes>(voxels, layout, scratch, gradients); }, volume->voxels);
  }

  /// The same sums, over weights alone, that a block beside padding takes: a whole neighbourhood gets the same fit in
  /// both.
  PlaneFit fit_of_whole_neighbourhood(int slice) const {
    const BlockLayout layout({{0, 0, slice}, {1, 1, 1}}, slices, cell_lanes);
    std::vector<float> buffer(layout.moment_floats(2) + layout.scratch_floats(2));
    const EverywhereOne ones;
    BlockSums<2, cell_lanes, EverywhereOne>(slices, layout, ones, buffer.data() + layout.moment_floats(2))
        .run(buffer.data());
    return internal::fit_plane(buffer.data(), layout.plane(), scale_mm, to_patient);
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
    weights->whole_neighbourhood.push_back(weights->fit_of_whole_neighbourhood(k));
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

void GradientKernel::at_block(const Block& block, std::span<glm::vec3> gradients) const {
  const BlockLayout layout(block, weights_->slices, block_lanes);
  std::vector<float> scratch(layout.moment_floats(1) + layout.moment_floats(2) + layout.scratch_floats(2));
  weights_->run<block_lanes>(layout, scratch.data(), gradients.data());
}

std::vector<glm::vec3> GradientKernel::whole(const Progress& progress, int threads) const {
  const Volume& volume = *weights_->volume;
  const glm::ivec3 size = volume.geometry.dimensions;
  const glm::ivec3 edge(128, 32, 32);  // a block's sums stay in the second-level cache
  const glm::ivec3 blocks = (size + edge - 1) / edge;
  std::vector<glm::vec3> gradients(volume.offset(0, 0, size.z));
  const auto one = [&](std::size_t number) {
    const int n = static_cast<int>(number);
    Block block;
    block.first = glm::ivec3(n % blocks.x, n / blocks.x % blocks.y, n / blocks.x / blocks.y) * edge;
    block.size = glm::min(edge, size - block.first);
    std::vector<glm::vec3> part(static_cast<std::size_t>(block.size.x * block.size.y * block.size.z));
    at_block(block, part);
    auto from = part.begin();
    for (int k = 0; k < block.size.z; ++k) {
      for (int j = 0; j < block.size.y; ++j) {
        const auto to = gradients.begin() +
                        static_cast<std::ptrdiff_t>(volume.offset(block.first.x, block.first.y + j, block.first.z + k));
        std::copy(from, from + block.size.x, to);
        from += block.size.x;
      }
    }
  };
  internal::parallel_for(static_cast<std::size_t>(blocks.x * blocks.y * blocks.z), one, progress, threads);
  return gradients;
}

}  // namespace palpate::io
