#pragma once

/// Weighted sums over the neighbourhoods of a block of voxels: of the values, and of the values times their offsets in
/// mm, up to an order. Rows first, then columns, then slices; `lanes` voxels of a row side by side, each summed in the
/// same order whatever the block, so that the sums of a voxel have the same bits in every block.

#include <algorithm>

#include "palpate/io/gradient.h"
#include "palpate/io/internal/slice_kernel.h"

namespace palpate::io::internal {

/// Sums in a plane: order 1: 1, p, q; order 2 also pp, pq, qq (p along i, q along j).
constexpr int plane_sums(int order) {
  return order == 1 ? 3 : 6;
}
/// Sums in space: order 1: 1, p, q, w; order 2 also pp, pq, qq, pw, qw, ww (w along the normal).
constexpr int space_sums(int order) {
  return order == 1 ? 4 : 10;
}

/// How a block lies in a scratch buffer of floats.
struct BlockLayout {
  Block block;
  int width = 0;       ///< block.size.x rounded up to whole lanes
  int row_floats = 0;  ///< one row of the volume, with the kernel's reach on both sides
  int rows = 0;        ///< rows that the block's columns reach over
  int first_slice = 0;
  int slices = 0;  ///< slices that the block reaches over and that exist
  glm::ivec3 radius{0};

  BlockLayout(const Block& b, const SliceKernel& kernel, int lanes) : block(b), radius(kernel.radius) {
    width = (b.size.x + lanes - 1) / lanes * lanes;
    row_floats = width + 2 * radius.x;
    rows = b.size.y + 2 * radius.y;
    first_slice = std::max(b.first.z - radius.z, 0);
    slices = std::min(b.first.z + b.size.z + radius.z, static_cast<int>(kernel.of_slice.size())) - first_slice;
  }
  std::size_t plane() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(block.size.y); }
  /// Offset of a sum at the first voxel of a row of the block in what moments() wrote.
  std::size_t at(int order, int sum, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(space_sums(order)) + static_cast<std::size_t>(sum)) *
               plane() +
           static_cast<std::size_t>(j) * static_cast<std::size_t>(width);
  }
  std::size_t moment_floats(int order) const {
    return static_cast<std::size_t>(block.size.z) * static_cast<std::size_t>(space_sums(order)) * plane();
  }
  std::size_t scratch_floats(int order) const {
    return static_cast<std::size_t>(row_floats) +
           static_cast<std::size_t>(rows) * static_cast<std::size_t>(order + 1) * static_cast<std::size_t>(width) +
           static_cast<std::size_t>(slices) * static_cast<std::size_t>(plane_sums(order)) * plane();
  }
};

/// LoadRow: void(int slice, int j, int i, int count, float* row): voxels i ... i + count - 1 of a row, 0 where there
/// are none.
template <int Order, int Lanes, typename LoadRow>
class BlockSums {
 public:
  BlockSums(const SliceKernel& kernel, const BlockLayout& layout, const LoadRow& load_row, float* scratch)
      : kernel_(kernel),
        layout_(layout),
        load_row_(load_row),
        row_(scratch),
        filtered_rows_(row_ + layout.row_floats),
        planes_(filtered_rows_ + layout.rows * (Order + 1) * layout.width) {}

  void run(float* sums) {
    if (kernel_.straight) {
      for (int n = 0; n < layout_.slices; ++n) {
        filter_plane(layout_.first_slice + n, 0, plane_of(n));
      }
    }
    for (int k = 0; k < layout_.block.size.z; ++k) {
      float* const out = sums + layout_.at(Order, 0, 0, k);
      std::fill(out, out + space_sums(Order) * layout_.plane(), 0.0F);
      for (const Contribution& c : kernel_.of_slice[static_cast<std::size_t>(layout_.block.first.z + k)]) {
        float* plane = plane_of(0);
        if (kernel_.straight) {
          plane = plane_of(c.slice - layout_.first_slice);
        } else {
          filter_plane(c.slice, c.taps, plane);
        }
        add_plane(c, plane, out);
      }
    }
  }

 private:
  float* plane_of(int n) const { return planes_ + static_cast<std::size_t>(n * plane_sums(Order)) * layout_.plane(); }
  float* filtered_row(int row, int power) const { return filtered_rows_ + (row * (Order + 1) + power) * layout_.width; }

  void filter_plane(int slice, int taps, float* plane) {
    const Taps& along_i = kernel_.taps_i[static_cast<std::size_t>(taps)];
    const Taps& along_j = kernel_.taps_j[static_cast<std::size_t>(taps)];
    const auto [lowest, highest] = std::minmax_element(along_j.begin(), along_j.end(),
                                                       [](const Tap& a, const Tap& b) { return a.offset < b.offset; });
    for (int row = layout_.radius.y + lowest->offset; row < layout_.block.size.y + layout_.radius.y + highest->offset;
         ++row) {
      load_row_(slice, layout_.block.first.y + row - layout_.radius.y, layout_.block.first.x - layout_.radius.x,
                layout_.row_floats, row_);
      for (int i = 0; i < layout_.width; i += Lanes) {
        filter_row(along_i, row, i);
      }
    }
    for (int j = 0; j < layout_.block.size.y; ++j) {
      for (int i = 0; i < layout_.width; i += Lanes) {
        filter_column(along_j, j, i, plane);
      }
    }
  }

  void filter_row(const Taps& taps, int row, int i) {
    float sum[Order + 1][Lanes] = {};
    for (const Tap& tap : taps) {
      const float* const in = row_ + layout_.radius.x + i + tap.offset;
      for (int power = 0; power <= Order; ++power) {
        for (int lane = 0; lane < Lanes; ++lane) {
          sum[power][lane] += tap.weight[power] * in[lane];
        }
      }
    }
    for (int power = 0; power <= Order; ++power) {
      std::copy(sum[power], sum[power] + Lanes, filtered_row(row, power) + i);
    }
  }

  void filter_column(const Taps& taps, int j, int i, float* plane) {
    // Powers of p and q of each sum, in the order of plane_sums().
    constexpr int power_p[6] = {0, 1, 0, 2, 1, 0};
    constexpr int power_q[6] = {0, 0, 1, 0, 1, 2};
    float sum[plane_sums(Order)][Lanes] = {};
    for (const Tap& tap : taps) {
      const int row = j + layout_.radius.y + tap.offset;
      for (int n = 0; n < plane_sums(Order); ++n) {
        const float* const in = filtered_row(row, power_p[n]) + i;
        for (int lane = 0; lane < Lanes; ++lane) {
          sum[n][lane] += tap.weight[power_q[n]] * in[lane];
        }
      }
    }
    for (int n = 0; n < plane_sums(Order); ++n) {
      std::copy(sum[n], sum[n] + Lanes, plane + n * layout_.plane() + static_cast<std::size_t>(j * layout_.width + i));
    }
  }

  /// Moves a slice's sums from its own voxels' places to the offsets from the slice in hand, and adds them up.
  void add_plane(const Contribution& c, const float* plane, float* out) const {
    const std::size_t size = layout_.plane();
    for (std::size_t n = 0; n < size; n += Lanes) {
      const float* const b = plane + n;
      float* const s = out + n;
      if (kernel_.straight) {
        add_straight(c, b, s, size);
      } else {
        add_shifted(c, b, s, size);
      }
    }
  }

  static void add_straight(const Contribution& c, const float* b, float* s, std::size_t size) {
    const float w = c.weight;
    const float wz = c.weight * c.offset[2];
    const float wzz = wz * c.offset[2];
    for (int l = 0; l < Lanes; ++l) {
      s[l] += w * b[l];
      s[size + l] += w * b[size + l];
      s[2 * size + l] += w * b[2 * size + l];
      s[3 * size + l] += wz * b[l];
    }
    if constexpr (Order == 2) {
      for (int l = 0; l < Lanes; ++l) {
        s[4 * size + l] += w * b[3 * size + l];
        s[5 * size + l] += w * b[4 * size + l];
        s[6 * size + l] += w * b[5 * size + l];
        s[7 * size + l] += wz * b[size + l];
        s[8 * size + l] += wz * b[2 * size + l];
        s[9 * size + l] += wzz * b[l];
      }
    }
  }

  static void add_shifted(const Contribution& c, const float* b, float* s, std::size_t size) {
    const float w = c.weight;
    const float x = c.offset[0];
    const float y = c.offset[1];
    const float z = c.offset[2];
    for (int l = 0; l < Lanes; ++l) {
      const float m = b[l];
      const float p = b[size + l] + x * m;
      const float q = b[2 * size + l] + y * m;
      s[l] += w * m;
      s[size + l] += w * p;
      s[2 * size + l] += w * q;
      s[3 * size + l] += w * (z * m);
      if constexpr (Order == 2) {
        s[4 * size + l] += w * (b[3 * size + l] + x * (b[size + l] + p));      // (p + x)^2
        s[5 * size + l] += w * (b[4 * size + l] + y * b[size + l] + x * q);    // (p + x)(q + y)
        s[6 * size + l] += w * (b[5 * size + l] + y * (b[2 * size + l] + q));  // (q + y)^2
        s[7 * size + l] += w * (z * p);
        s[8 * size + l] += w * (z * q);
        s[9 * size + l] += w * (z * (z * m));
      }
    }
  }

  const SliceKernel& kernel_;
  const BlockLayout& layout_;
  const LoadRow& load_row_;
  float* row_;
  float* filtered_rows_;
  float* planes_;
};

}  // namespace palpate::io::internal
