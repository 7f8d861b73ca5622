#include "io/fields/central_differences.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/matrix.hpp>
#include <type_traits>

#include "io/fields/padded_rows.h"
#include "io/for_processor.h"
#include "io/padding.h"

namespace palpate::io::internal {
namespace {

using Weights = CentralDifferences::Weights;
using Sides = CentralDifferences::Sides;

constexpr int stretch = 32;  // voxels of a row that are decided at once, where it holds padding

struct Differences {
  float i = 0, j = 0, up = 0, down = 0;
};

[[gnu::always_inline]] inline float combined(const Weights& weights, const Differences& d, int axis) {
  return ((weights.along_i[axis] * d.i + weights.along_j[axis] * d.j) +
          (weights.up[axis] * d.up + weights.down[axis] * d.down)) +
         0.0F;
}

/// Rows around the current one, at its first voxel; a missing row is replaced by the row itself.
template <typename Stored>
struct Rows {
  const Stored* middle;
  const Stored* before;
  const Stored* after;
  float share_j;  ///< of the difference between them: a half, or all where one is the row itself
  const Stored* up;
  const Stored* down;
};

/// `count` voxels that have both neighbors along i.
template <typename Stored>
[[gnu::always_inline]] inline void difference_row(const Rows<Stored>& rows, const Weights& weights, int count,
                                                  glm::vec3* gradients) {
  const Stored* __restrict const middle = rows.middle;
  const Stored* __restrict const before = rows.before;
  const Stored* __restrict const after = rows.after;
  const Stored* __restrict const up = rows.up;
  const Stored* __restrict const down = rows.down;
  const Weights w = weights;
  const float share_j = rows.share_j;
  float* __restrict const out = &gradients->x;
  PALPATE_INDEPENDENT
  for (std::ptrdiff_t n = 0; n < count; ++n) {
    const auto here = static_cast<float>(middle[n]);
    const Differences d{0.5F * (static_cast<float>(middle[n + 1]) - static_cast<float>(middle[n - 1])),
                        share_j * (static_cast<float>(after[n]) - static_cast<float>(before[n])),
                        static_cast<float>(up[n]) - here, here - static_cast<float>(down[n])};
    out[3 * n] = combined(w, d, 0);
    out[3 * n + 1] = combined(w, d, 1);
    out[3 * n + 2] = combined(w, d, 2);
  }
}

PALPATE_FOR_PROCESSOR
void run_row(const Rows<std::int16_t>& rows, const Weights& weights, int count, glm::vec3* gradients) {
  difference_row(rows, weights, count, gradients);
}
PALPATE_FOR_PROCESSOR
void run_row(const Rows<std::uint16_t>& rows, const Weights& weights, int count, glm::vec3* gradients) {
  difference_row(rows, weights, count, gradients);
}
PALPATE_FOR_PROCESSOR
void run_row(const Rows<float>& rows, const Weights& weights, int count, glm::vec3* gradients) {
  difference_row(rows, weights, count, gradients);
}

/// Which rows there are beside the one in hand.
struct Around {
  bool before, after, above, below;
};

/// `yes` if the flag is 1, `no` if it is 0. With bit operations: a branch would prevent vectorization.
[[gnu::always_inline]] inline float either(std::uint32_t flag, float yes, float no) {
  const std::uint32_t mask = 0U - flag;
  return std::bit_cast<float>((std::bit_cast<std::uint32_t>(yes) & mask) | (std::bit_cast<std::uint32_t>(no) & ~mask));
}

/// The same with whatever neighbors each voxel has; in padding 0.
template <typename Stored>
[[gnu::always_inline]] inline void difference_padded_row(const Rows<Stored>& rows, const Around& around,
                                                         const StoredPadding<Stored>& given,
                                                         const std::array<Weights, 4>& weights, int count,
                                                         glm::vec3* gradients) {
  const Stored* __restrict const middle = rows.middle;
  const Stored* __restrict const before = rows.before;
  const Stored* __restrict const after = rows.after;
  const Stored* __restrict const up = rows.up;
  const Stored* __restrict const down = rows.down;
  const StoredPadding<Stored> padding = given;
  const std::uint32_t no_before = around.before ? 0 : 1, no_after = around.after ? 0 : 1;
  const std::uint32_t no_above = around.above ? 0 : 1, no_below = around.below ? 0 : 1;
  const std::array<Weights, 4> w = weights;
  float* __restrict const out = &gradients->x;
  PALPATE_INDEPENDENT
  for (std::ptrdiff_t n = 0; n < count; ++n) {
    const auto here = static_cast<float>(middle[n]);
    const std::uint32_t none = padding(middle[n]);
    const std::uint32_t no_left = padding(middle[n - 1]), no_right = padding(middle[n + 1]);
    const std::uint32_t no_front = padding(before[n]) | no_before, no_back = padding(after[n]) | no_after;
    const std::uint32_t no_up = padding(up[n]) | no_above, no_down = padding(down[n]) | no_below;
    const auto value = [here](Stored stored, std::uint32_t is_none) __attribute__((always_inline)) {
      return either(is_none, here, static_cast<float>(stored));
    };
    const float i =
        either(no_left | no_right, 1.0F, 0.5F) * (value(middle[n + 1], no_right) - value(middle[n - 1], no_left));
    const float j = either(no_front | no_back, 1.0F, 0.5F) * (value(after[n], no_back) - value(before[n], no_front));
    const float above = value(up[n], no_up) - here, below = here - value(down[n], no_down);
    const auto chosen = [&](float alone, float with_up, float with_down, float with_both)
        __attribute__((always_inline)) {
      return either(no_down, either(no_up, alone, with_up), either(no_up, with_down, with_both));
    };
    for (int a = 0; a < 3; ++a) {
      const float along_i = chosen(w[0].along_i[a], w[1].along_i[a], w[2].along_i[a], w[3].along_i[a]);
      const float along_j = chosen(w[0].along_j[a], w[1].along_j[a], w[2].along_j[a], w[3].along_j[a]);
      const float along_up = chosen(w[0].up[a], w[1].up[a], w[2].up[a], w[3].up[a]);
      const float along_down = chosen(w[0].down[a], w[1].down[a], w[2].down[a], w[3].down[a]);
      const float sum = ((along_i * i + along_j * j) + (along_up * above + along_down * below)) + 0.0F;
      out[3 * n + a] = either(none, 0.0F, sum);
    }
  }
}

PALPATE_FOR_PROCESSOR
void run_padded_row(const Rows<std::int16_t>& rows, const Around& around, const StoredPadding<std::int16_t>& padding,
                    const std::array<Weights, 4>& weights, int count, glm::vec3* gradients) {
  difference_padded_row(rows, around, padding, weights, count, gradients);
}
PALPATE_FOR_PROCESSOR
void run_padded_row(const Rows<std::uint16_t>& rows, const Around& around, const StoredPadding<std::uint16_t>& padding,
                    const std::array<Weights, 4>& weights, int count, glm::vec3* gradients) {
  difference_padded_row(rows, around, padding, weights, count, gradients);
}
PALPATE_FOR_PROCESSOR
void run_padded_row(const Rows<float>& rows, const Around& around, const StoredPadding<float>& padding,
                    const std::array<Weights, 4>& weights, int count, glm::vec3* gradients) {
  difference_padded_row(rows, around, padding, weights, count, gradients);
}

/// One voxel with whatever neighbors it has.
template <typename Stored>
class AtVoxel {
 public:
  AtVoxel(const Volume& volume, const std::vector<Stored>& voxels)
      : volume_(volume), voxels_(voxels.data()), padding_(volume) {}

  glm::vec3 operator()(const glm::ivec3& v, Sides slices, const std::array<Weights, 4>& weights) const noexcept {
    if (is_padding(v)) {
      return glm::vec3(0);
    }
    const bool has_above = (slices & CentralDifferences::above) != 0 && !is_padding(v + glm::ivec3(0, 0, 1));
    const bool has_below = (slices & CentralDifferences::below) != 0 && !is_padding(v - glm::ivec3(0, 0, 1));
    const float here = at(v);
    const Differences d{in_plane(v, 0), in_plane(v, 1), has_above ? at(v + glm::ivec3(0, 0, 1)) - here : 0,
                        has_below ? here - at(v - glm::ivec3(0, 0, 1)) : 0};
    const Weights& w = weights[(has_above ? 1U : 0U) + (has_below ? 2U : 0U)];
    return {combined(w, d, 0), combined(w, d, 1), combined(w, d, 2)};
  }
  const StoredPadding<Stored>& padding() const noexcept { return padding_; }
  bool is_all_padding(const glm::ivec3& first, int count) const noexcept {
    return all_padding(voxels_ + volume_.offset(first.x, first.y, first.z), count, padding_);
  }
  bool holds_padding(const glm::ivec3& first, int count) const noexcept {
    return any_padding(voxels_ + volume_.offset(first.x, first.y, first.z), count, padding_);
  }

 private:
  float at(const glm::ivec3& v) const noexcept { return static_cast<float>(voxels_[volume_.offset(v.x, v.y, v.z)]); }
  bool is_padding(const glm::ivec3& v) const noexcept { return padding_(voxels_[volume_.offset(v.x, v.y, v.z)]) != 0; }

  float in_plane(const glm::ivec3& v, int axis) const noexcept {
    glm::ivec3 before = v;
    glm::ivec3 after = v;
    --before[axis];
    ++after[axis];
    const bool has_before = v[axis] > 0 && !is_padding(before);
    const bool has_after = v[axis] + 1 < volume_.geometry.dimensions[axis] && !is_padding(after);
    const float share = has_before && has_after ? 0.5F : 1.0F;
    return share * (at(has_after ? after : v) - at(has_before ? before : v));
  }

  const Volume& volume_;
  const Stored* voxels_;
  StoredPadding<Stored> padding_;
};

/// One row of a block; voxels are counted from its first.
template <typename Stored>
struct RowOfBlock {
  const Volume& volume;
  const Stored* voxels;
  const AtVoxel<Stored>& at_voxel;
  const std::array<Weights, 4>& weights;
  Sides sides;
  glm::ivec3 first;
  std::array<int, 2> neighbors_j, neighbors_k;
  glm::vec3* out;

  void one_by_one(int from, int to) const noexcept {
    for (int i = from; i < to; ++i) out[i] = at_voxel({first.x + i, first.y, first.z}, sides, weights);
  }
  Rows<Stored> rows_from(int from) const noexcept {
    const auto row = [&](int y, int z) { return voxels + volume.offset(first.x + from, y, z); };
    const float share_j = neighbors_j[0] < first.y && first.y < neighbors_j[1] ? 0.5F : 1.0F;
    return {row(first.y, first.z),        row(neighbors_j[0], first.z), row(neighbors_j[1], first.z), share_j,
            row(first.y, neighbors_k[1]), row(first.y, neighbors_k[0])};
  }
  void together(int from, int to) const noexcept { run_row(rows_from(from), weights[sides], to - from, out + from); }
  void beside_padding(int from, int to) const noexcept {
    const Around around{neighbors_j[0]<first.y, neighbors_j[1]> first.y, neighbors_k[1] > first.z,
                        neighbors_k[0] < first.z};
    if (at_voxel.is_all_padding({first.x + from, first.y, first.z}, to - from)) {
      std::fill(out + from, out + to, glm::vec3(0));
      return;
    }
    run_padded_row(rows_from(from), around, at_voxel.padding(), weights, to - from, out + from);
  }
  bool is_beside_padding(int from, int to) const noexcept {
    const int x = first.x + from, count = to - from;
    return at_voxel.holds_padding({x - 1, first.y, first.z}, count + 2) ||
           at_voxel.holds_padding({x, neighbors_j[0], first.z}, count) ||
           at_voxel.holds_padding({x, neighbors_j[1], first.z}, count) ||
           at_voxel.holds_padding({x, first.y, neighbors_k[1]}, count) ||
           at_voxel.holds_padding({x, first.y, neighbors_k[0]}, count);
  }
};

/// Weights of the slices on both sides, if they count.
Weights weights_of(const glm::dmat3& basis, const Vec3& up, const Vec3& down, Sides sides, double slope) {
  const glm::dmat3 inverse = glm::inverse(basis);
  const glm::dmat3 dual = glm::transpose(inverse);
  const Vec3 u = inverse * up;  // steps along i and j, mm along the normal
  const Vec3 d = inverse * down;
  const bool has_up = (sides & CentralDifferences::above) != 0;
  const bool has_down = (sides & CentralDifferences::below) != 0;
  const double share_up = !has_up ? 0 : has_down ? d.z / (u.z + d.z) : 1;
  const double share_down = has_down ? 1 - share_up : 0;
  const double per_up = has_up ? share_up / u.z : 0;
  const double per_down = has_down ? share_down / d.z : 0;
  const Vec3 along_i = dual[0] - dual[2] * (per_up * u.x + per_down * d.x);
  const Vec3 along_j = dual[1] - dual[2] * (per_up * u.y + per_down * d.y);
  return {glm::vec3(slope * along_i), glm::vec3(slope * along_j), glm::vec3(slope * per_up * dual[2]),
          glm::vec3(slope * per_down * dual[2])};
}

}  // namespace

CentralDifferences::CentralDifferences(const Geometry& g, double slope) {
  const glm::dmat3 basis(g.spacing_i * g.direction_i, g.spacing_j * g.direction_j,
                         glm::normalize(glm::cross(g.direction_i, g.direction_j)));
  const auto is_gap = [&](int k) { return std::binary_search(g.gaps.begin(), g.gaps.end(), k); };
  for (int k = 0; k < g.dimensions.z; ++k) {
    const auto at = static_cast<std::size_t>(k);
    const bool has_above = k + 1 < g.dimensions.z && !is_gap(k);
    const bool has_below = k > 0 && !is_gap(k - 1);
    // The same bits all through an even volume.
    const Vec3 up = g.uniform || !has_above ? g.step : g.slice_positions[at + 1] - g.slice_positions[at];
    const Vec3 down = g.uniform || !has_below ? g.step : g.slice_positions[at] - g.slice_positions[at - 1];
    std::array<Weights, 4> weights;
    for (unsigned sides = neither; sides <= both; ++sides) {
      weights[sides] = weights_of(basis, up, down, static_cast<Sides>(sides), slope);
    }
    of_slice_.push_back(weights);
    sides_.push_back(static_cast<Sides>((has_above ? 1U : 0U) + (has_below ? 2U : 0U)));
  }
}

template <typename Stored>
void CentralDifferences::run(const Volume& volume, const std::vector<Stored>& voxels, const Block& block,
                             const GradientTarget& target) const noexcept {
  const AtVoxel<Stored> at_voxel(volume, voxels);
  const glm::ivec3 size = volume.geometry.dimensions;
  const bool may_be_padding = StoredPadding<Stored>(volume).possible();
  const int first = std::clamp(1 - block.first.x, 0, block.size.x);
  const int last = std::clamp(size.x - 1 - block.first.x, first, block.size.x);
  for (int k = block.first.z; k < block.first.z + block.size.z; ++k) {
    const Sides sides = sides_[static_cast<std::size_t>(k)];
    const auto& weights = of_slice_[static_cast<std::size_t>(k)];
    const int above_k = k + ((sides & above) != 0 ? 1 : 0);
    const int below_k = k - ((sides & below) != 0 ? 1 : 0);
    for (int j = block.first.y; j < block.first.y + block.size.y; ++j) {
      glm::vec3* const out = target.first + (k - block.first.z) * target.slice + (j - block.first.y) * target.row;
      const int before = std::max(j - 1, 0);
      const int after = std::min(j + 1, size.y - 1);
      const RowOfBlock<Stored> row{volume,          voxels.data(),      at_voxel, weights, sides, {block.first.x, j, k},
                                   {before, after}, {below_k, above_k}, out};
      row.one_by_one(0, first);
      if (!may_be_padding || first == last || !row.is_beside_padding(first, last)) {
        if (first < last) row.together(first, last);
      } else {
        for (int from = first; from < last; from += stretch) {
          const int to = std::min(from + stretch, last);
          row.is_beside_padding(from, to) ? row.beside_padding(from, to) : row.together(from, to);
        }
      }
      row.one_by_one(last, block.size.x);
    }
  }
}

void CentralDifferences::at_block(const Volume& volume, const Block& block,
                                  const GradientTarget& target) const noexcept {
  std::visit([&](const auto& voxels) { run(volume, voxels, block, target); }, volume.voxels);
}

}  // namespace palpate::io::internal
