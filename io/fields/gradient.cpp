#include "io/fields/gradient.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <limits>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <utility>

#include "io/fields/central_differences.h"
#include "io/fields/fits.h"
#include "io/fields/moments.h"
#include "io/fields/plane_fit.h"
#include "io/fields/row_reader.h"
#include "io/fields/second_derivatives.h"
#include "io/fields/slice_kernel.h"
#include "io/fields/straight_block.h"
#include "io/fields/tilted_block.h"
#include "io/pages.h"
#include "io/parallel.h"

namespace palpate::io {
namespace {

using internal::BlockLayout;
using internal::BlockSums;
using internal::GradientTarget;
using internal::PlaneFit;
using internal::RowReader;
using internal::space_sums;

constexpr int cell_lanes = 4;
constexpr int block_lanes = 8;

/// The largest scratch memory for a single cell: on the stack, since the tick may not allocate.
constexpr int cell_floats = [] {
  constexpr int reach = 2 * internal::largest_radius + 2;
  constexpr int row = cell_lanes + 2 * internal::largest_radius;
  return row + reach * 3 * cell_lanes + reach * internal::plane_sums(2) * 2 * cell_lanes +
         2 * (space_sums(1) + space_sums(2)) * 2 * cell_lanes;
}();

/// Blocks of a whole volume: large ones share more of their neighborhoods, and small ones need less memory for
/// gradients that are not kept.
constexpr glm::ivec3 kept_block(512, 48, 128);
constexpr glm::ivec3 passing_block(512, 24, 64);

std::vector<Block> blocks_of(const glm::ivec3& size, const glm::ivec3& longest) {
  std::vector<Block> blocks;
  glm::ivec3 at(0);
  for (at.z = 0; at.z < size.z; at.z += longest.z) {
    for (at.y = 0; at.y < size.y; at.y += longest.y) {
      for (at.x = 0; at.x < size.x; at.x += longest.x) {
        blocks.push_back({at, glm::min(longest, size - at)});
      }
    }
  }
  return blocks;
}

/// Memory for a block's gradients, for one thread after the other. Not set.
class Buffers {
 public:
  using Buffer = std::unique_ptr<glm::vec3[]>;

  explicit Buffers(std::size_t largest) : largest_(largest) {}

  Buffer take() {
    const std::scoped_lock lock(mutex_);
    if (free_.empty()) return std::make_unique_for_overwrite<glm::vec3[]>(largest_);
    Buffer last = std::move(free_.back());
    free_.pop_back();
    return last;
  }
  void give_back(Buffer buffer) {
    const std::scoped_lock lock(mutex_);
    free_.push_back(std::move(buffer));
  }

 private:
  std::size_t largest_;
  std::mutex mutex_;
  std::vector<Buffer> free_;
};

GradientTarget packed(const Block& block, glm::vec3* gradients) {
  return {gradients, block.size.x, static_cast<std::ptrdiff_t>(block.size.x) * block.size.y};
}

}  // namespace

struct GradientKernel::Weights {
  std::shared_ptr<const Volume> volume;
  double scale_mm = 0;
  std::optional<internal::CentralDifferences> differences;  ///< instead of all that follows
  internal::SliceKernel slices;
  glm::dmat3 to_patient{1};
  internal::Fits fits;

  /// Any block by the sums of moments.h.
  template <int Lanes, typename Stored>
  void run(const std::vector<Stored>& voxels, const BlockLayout& layout, float* scratch,
           const GradientTarget& target) const noexcept {
    float* const sums = scratch;
    float* const weights = sums + layout.moment_floats(1);
    float* const rest = weights + layout.moment_floats(2);
    const RowReader<Stored> values(*volume, voxels, false);
    BlockSums<1, Lanes, RowReader<Stored>>(slices, layout, values, rest).run(sums);
    const bool complete = values.complete();
    const bool needs_weights = values.met_padding() || (!complete && !fits.knows_edges());
    if (needs_weights) {
      const RowReader<Stored> mask(*volume, voxels, true);
      BlockSums<2, Lanes, RowReader<Stored>>(slices, layout, mask, rest).run(weights);
    }
    const glm::ivec3 first = layout.block.first;
    for (int k = 0; k < layout.block.size.z; ++k) {
      for (int j = 0; j < layout.block.size.y; ++j) {
        const float* const row = sums + layout.at(1, 0, j, k);
        const float* const weight_row = weights + layout.at(2, 0, j, k);
        glm::vec3* const gradients = target.first + k * target.slice + j * target.row;
        for (int i = 0; i < layout.block.size.x; ++i) {
          const PlaneFit fit = complete ? fits.whole(first.z + k)
                               : needs_weights
                                   ? internal::fit_plane(weight_row + i, layout.plane(), scale_mm, to_patient)
                                   : fits.at(first.x + i, first.y + j, first.z + k);
          gradients[i] = internal::gradient_of(fit, row + i, layout.plane());
        }
      }
    }
  }

  template <int Lanes>
  void run(const BlockLayout& layout, float* scratch, const GradientTarget& target) const noexcept {
    std::visit([&](const auto& voxels) { run<Lanes>(voxels, layout, scratch, target); }, volume->voxels);
  }

  /// A block in whatever way is fastest; they all give the same bits.
  void run(const Block& block, const GradientTarget& target) const {
    if (differences) {
      differences->at_block(*volume, block, target);
      return;
    }
    std::visit(
        [&](const auto& v) {
          slices.straight ? internal::straight_block(*volume, v, slices, fits, block, target)
                          : internal::tilted_block(*volume, v, slices, fits, block, target);
        },
        volume->voxels);
  }

  template <int Lanes, typename Stored>
  void run_hessians(const std::vector<Stored>& voxels, const BlockLayout& layout, float* scratch,
                    Hessian* out) const noexcept {
    float* const counted = scratch + layout.moment_floats(2);
    float* const rest = counted + layout.moment_floats(1);
    const RowReader<Stored> values(*volume, voxels, false);
    BlockSums<2, Lanes, RowReader<Stored>>(slices, layout, values, rest).run(scratch);
    const bool complete = values.complete();
    if (!complete) {
      const RowReader<Stored> mask(*volume, voxels, true);
      BlockSums<1, Lanes, RowReader<Stored>>(slices, layout, mask, rest).run(counted);
    }
    for (int k = 0; k < layout.block.size.z; ++k) {
      const int slice = layout.block.first.z + k;
      const internal::SecondDerivatives second(fits.whole_sums(slice), scale_mm, to_patient);
      const bool all_slices = slice >= slices.radius.z && slice + slices.radius.z < volume->geometry.dimensions.z;
      for (int j = 0; j < layout.block.size.y; ++j) {
        const float* const sums = scratch + layout.at(2, 0, j, k);
        const float* const weight = counted + layout.at(1, 0, j, k);
        for (int i = 0; i < layout.block.size.x; ++i) {
          // Every weight that is missing is missing from the sum, and the sum is taken in the same order.
          const bool is_whole = all_slices && (complete || weight[i] == fits.whole_sums(slice)[0]);
          *out++ = is_whole ? second(sums + i, layout.plane()) : internal::unknown_hessian();
        }
      }
    }
  }

  template <int Lanes>
  void run_hessians(const BlockLayout& layout, float* scratch, Hessian* out) const noexcept {
    std::visit([&](const auto& voxels) { run_hessians<Lanes>(voxels, layout, scratch, out); }, volume->voxels);
  }
};

double largest_gradient_scale_mm(const Geometry& geometry) noexcept {
  // The kernel's reach without the displacement of a tilted stack's nearest slices, which always count.
  const Vec3 normal = glm::normalize(glm::cross(geometry.direction_i, geometry.direction_j));
  const auto& slices = geometry.slice_positions;
  const std::array<std::pair<Vec3, double>, 2> rows{
      {{geometry.direction_i, geometry.spacing_i}, {geometry.direction_j, geometry.spacing_j}}};
  constexpr double reach = internal::largest_radius - 1;
  double largest = std::numeric_limits<double>::infinity();
  for (const auto& [direction, spacing] : rows) {
    largest = std::min(largest, reach * spacing / internal::cut_off);
    for (std::size_t k = 1; k < slices.size(); ++k) {
      const Vec3 step = slices[k] - slices[k - 1];
      const double between = std::abs(glm::dot(step, normal));
      const double shift = std::abs(glm::dot(step, direction));
      const double tilt = between > 0 ? shift / between : 0;
      const double left = std::max(reach * spacing - shift, spacing);
      largest = std::min({largest, left / internal::cut_off, reach * spacing / (internal::cut_off * (1 + tilt))});
    }
  }
  constexpr std::size_t beyond = internal::largest_radius + 1;
  for (std::size_t k = beyond; k < slices.size(); ++k) {
    const double between = std::abs(glm::dot(slices[k] - slices[k - beyond], normal));
    largest = std::min(largest, 0.999 * between / internal::cut_off);
  }
  return largest;
}

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
  const double wanted = std::max(
      {least_mm, in_plane_voxels * std::max(geometry.spacing_i, geometry.spacing_j), slice_spacings * between});
  return std::min(wanted, largest_gradient_scale_mm(geometry));
}

GradientKernel::GradientKernel(std::shared_ptr<const Volume> volume, double scale_mm) {
  if (!volume) {
    throw std::logic_error("a gradient needs a volume");
  }
  auto weights = std::make_unique<Weights>();
  weights->slices = internal::make_slice_kernel(volume->geometry, scale_mm);
  weights->scale_mm = scale_mm;
  weights->to_patient = volume->slope * weights->slices.to_patient;
  weights->fits = internal::Fits(volume->geometry.dimensions, weights->slices, scale_mm, weights->to_patient);
  weights->volume = std::move(volume);
  weights_ = std::move(weights);
}

GradientKernel::GradientKernel(std::shared_ptr<const Volume> volume, CentralDifferences) {
  if (!volume) {
    throw std::logic_error("a gradient needs a volume");
  }
  const Geometry& g = volume->geometry;
  auto weights = std::make_unique<Weights>();
  weights->scale_mm = std::max({g.spacing_i, g.spacing_j, std::abs(g.slice_spacing())});
  weights->slices.radius = glm::ivec3(1);
  weights->differences.emplace(g, volume->slope);
  weights->volume = std::move(volume);
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
  const GradientTarget target = packed(cell, gradients.data());
  if (weights_->differences) {
    weights_->differences->at_block(*weights_->volume, cell, target);
    return;
  }
  alignas(64) std::array<float, cell_floats> scratch;
  weights_->run<cell_lanes>(BlockLayout(cell, weights_->slices, cell_lanes), scratch.data(), target);
}

void GradientKernel::hessians_at_cell(const Block& cell, std::span<Hessian> hessians) const noexcept {
  if (weights_->differences) {
    std::fill_n(hessians.begin(), cell.voxels(), internal::unknown_hessian());
    return;
  }
  alignas(64) std::array<float, cell_floats> scratch;
  weights_->run_hessians<cell_lanes>(BlockLayout(cell, weights_->slices, cell_lanes), scratch.data(), hessians.data());
}

void GradientKernel::hessians_at_block(const Block& block, std::span<Hessian> hessians) const {
  if (weights_->differences) {
    std::fill_n(hessians.begin(), block.voxels(), internal::unknown_hessian());
    return;
  }
  const BlockLayout layout(block, weights_->slices, block_lanes);
  const auto scratch = std::make_unique_for_overwrite<float[]>(layout.moment_floats(1) + layout.moment_floats(2) +
                                                               layout.scratch_floats(2));
  weights_->run_hessians<block_lanes>(layout, scratch.get(), hessians.data());
}

void GradientKernel::at_block(const Block& block, std::span<glm::vec3> gradients) const {
  weights_->run(block, packed(block, gradients.data()));
}

void GradientKernel::for_each_block(const std::function<void(const Block&, std::span<const glm::vec3>)>& use,
                                    const Progress& progress, int threads) const {
  const std::vector<Block> blocks = blocks_of(weights_->volume->geometry.dimensions, passing_block);
  // Fresh memory for each block would be cleared by the system and by us, which takes a fifth of the time.
  Buffers buffers(blocks.empty() ? 0 : blocks.front().voxels());
  const auto one = [&](std::size_t n) {
    auto buffer = buffers.take();
    const std::span gradients(buffer.get(), blocks[n].voxels());
    at_block(blocks[n], gradients);
    use(blocks[n], gradients);
    buffers.give_back(std::move(buffer));
  };
  internal::parallel_for(blocks.size(), one, progress, threads);
}

void GradientKernel::whole_into(std::span<glm::vec3> gradients, const Progress& progress, int threads) const {
  const Volume& volume = *weights_->volume;
  internal::prefer_large_pages(gradients.data(), gradients.size_bytes());
  const std::vector<Block> blocks = blocks_of(volume.geometry.dimensions, kept_block);
  const auto row = static_cast<std::ptrdiff_t>(volume.offset(0, 1, 0));
  const auto slice = static_cast<std::ptrdiff_t>(volume.offset(0, 0, 1));
  const auto one = [&](std::size_t n) {
    const glm::ivec3& first = blocks[n].first;
    weights_->run(blocks[n], {gradients.data() + volume.offset(first.x, first.y, first.z), row, slice});
  };
  internal::parallel_for(blocks.size(), one, progress, threads);
}

std::vector<glm::vec3> GradientKernel::whole(const Progress& progress, int threads) const {
  std::vector<glm::vec3> gradients;
  const std::size_t count = weights_->volume->offset(0, 0, weights_->volume->geometry.dimensions.z);
  gradients.reserve(count);
  internal::hand_out_pages(gradients.data(), count * sizeof(glm::vec3), threads);
  gradients.resize(count);
  whole_into(gradients, progress, threads);
  return gradients;
}

}  // namespace palpate::io
