#pragma once

/// Weighted sums over the neighborhoods of a block of voxels: of the values, and of the values times their offsets in
/// mm, up to an order. Rows first, then columns, then slices. `lanes` voxels of a row are computed together, each
/// summed in the same order in any block, so the sums of a voxel have the same bits in every block.

#include <algorithm>

#include "io/fields/gradient.h"
#include "io/fields/slice_kernel.h"

namespace palpate::io::internal {

/// Sums in a plane: order 1: 1, p, q; order 2 also pp, pq, qq (p along i, q along j).
constexpr int plane_sums(int order) {
  return order == 1 ? 3 : 6;
}
/// Sums in space: order 1: 1, p, q, w; order 2 also pp, pq, qq, pw, qw, ww (w along the normal).
constexpr int space_sums(int order) {
  return order == 1 ? 4 : 10;
}

/// The layout of a block in a scratch buffer of floats.
struct BlockLayout {
  Block block;
  int width = 0;       ///< block.size.x rounded up to whole lanes
  int row_floats = 0;  ///< one row of the volume, with the kernel's reach on both sides
  int rows = 0;        ///< rows within the kernel's reach of the block
  int first_slice = 0;
  int slices = 0;  ///< existing slices within the kernel's reach of the block
  glm::ivec3 radius{0};

  BlockLayout(const Block& b, const SliceKernel& kernel, int lanes) : block(b), radius(kernel.radius) {
    width = (b.size.x + lanes - 1) / lanes * lanes;
    row_floats = width + 2 * radius.x;
    rows = b.size.y + 2 * radius.y;
    first_slice = std::max(b.first.z - radius.z, 0);
    slices = std::min(b.first.z + b.size.z + radius.z, static_cast<int>(kernel.of_slice.size())) - first_slice;
  }
  std::size_t plane() const { return static_cast<std::size_t>(width) * static_cast<std::size_t>(block.size.y); }
  /// Offset of a sum in the output of moments(), at the first voxel of a row of the block.
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

/// A few adjacent voxels of a row. Four fill a register of any x86-64 processor; for wider vectors the compiler would
/// go through memory.
template <int Lanes>
struct Vector {
  static_assert(Lanes % 4 == 0);
  using Four [[gnu::vector_size(16)]] = float;
  Four part[Lanes / 4] = {};

  static Vector load(const float* from) noexcept {
    Vector v;
    __builtin_memcpy(v.part, from, sizeof v.part);
    return v;
  }
  void store(float* to) const noexcept { __builtin_memcpy(to, part, sizeof part); }
  Vector& operator+=(const Vector& other) noexcept {
    for (int n = 0; n < Lanes / 4; ++n) part[n] += other.part[n];
    return *this;
  }
  friend Vector operator+(Vector a, const Vector& b) noexcept { return a += b; }
  friend Vector operator-(Vector a, const Vector& b) noexcept {
    for (int n = 0; n < Lanes / 4; ++n) a.part[n] -= b.part[n];
    return a;
  }
  friend Vector operator*(float factor, Vector v) noexcept {
    for (Four& four : v.part) four = factor * four;
    return v;
  }
};

/// LoadRow: void(int slice, int j, int i, int count, float* row): voxels i ... i + count - 1 of a row, 0 if there
/// are none.
template <int Order, int Lanes, typename LoadRow>
class BlockSums {
 public:
  BlockSums(const SliceKernel& kernel, const BlockLayout& layout, const LoadRow& load_row, float* scratch)
      : kernel_(kernel),
        layout_(layout),
        load_row_(load_row),
        row_(scratch),
        rows_summed_(row_ + layout.row_floats),
        planes_(rows_summed_ + static_cast<std::size_t>(layout.rows) * (Order + 1) * width()) {}

  void run(float* sums) {
    // The lanes beyond the block's width are never read from the volume.
    std::fill(row_, row_ + layout_.row_floats, 0.0F);
    if (kernel_.straight) {
      for (int n = 0; n < layout_.slices; ++n) {
        sum_plane(layout_.first_slice + n, 0, plane_of(n));
      }
    }
    for (int k = 0; k < layout_.block.size.z; ++k) {
      const int slice = layout_.block.first.z + k;
      const auto& contributions = kernel_.of_slice[static_cast<std::size_t>(slice)];
      float* const out = sums + layout_.at(Order, 0, 0, k);
      if (kernel_.straight) {
        add_straight(contributions, out);
        continue;
      }
      std::fill(out, out + space_sums(Order) * layout_.plane(), 0.0F);
      for (const Contribution& c : contributions) {
        sum_plane(c.slice, c.taps, planes_);
        add_shifted(c, out);
      }
    }
  }

 private:
  using Vector = internal::Vector<Lanes>;
  static constexpr int in_plane = plane_sums(Order);
  static constexpr int in_space = space_sums(Order);

  std::size_t width() const { return static_cast<std::size_t>(layout_.width); }
  float* plane_of(int n) const { return planes_ + static_cast<std::size_t>(n) * in_plane * layout_.plane(); }
  float* row_summed(int row, int power) const {
    return rows_summed_ + (static_cast<std::size_t>(row) * (Order + 1) + static_cast<std::size_t>(power)) * width();
  }

  void sum_plane(int slice, int taps, float* plane) {
    const Taps& along_i = kernel_.taps_i[static_cast<std::size_t>(taps)];
    const Taps& along_j = kernel_.taps_j[static_cast<std::size_t>(taps)];
    // The taps are ordered from the middle outwards, so the last two are the outermost.
    const int outermost = along_j.back().offset;
    const int other = along_j.size() > 1 ? along_j[along_j.size() - 2].offset : outermost;
    const int first_row = layout_.radius.y + std::min(outermost, other);
    const int last_row = layout_.radius.y + std::max(outermost, other) + layout_.block.size.y - 1;
    for (int row = first_row; row <= last_row; ++row) {
      load_row_(slice, layout_.block.first.y + row - layout_.radius.y, layout_.block.first.x - layout_.radius.x,
                layout_.block.size.x + 2 * layout_.radius.x, row_);
      for (int i = 0; i < layout_.width; i += Lanes) {
        sum_row(along_i, row, i);
      }
    }
    for (int j = 0; j < layout_.block.size.y; ++j) {
      for (int i = 0; i < layout_.width; i += Lanes) {
        sum_column(along_j, j, i, plane);
      }
    }
  }

  void sum_row(const Taps& taps, int row, int i) {
    Vector sum[Order + 1] = {};
    const float* const middle = row_ + layout_.radius.x + i;
    const std::size_t alone = kernel_.straight ? 1 : taps.size();
    for (std::size_t t = 0; t < alone; ++t) {
      const Vector in = Vector::load(middle + taps[t].offset);
      for (int power = 0; power <= Order; ++power) {
        sum[power] += taps[t].weight[power] * in;
      }
    }
    for (std::size_t t = alone; t + 1 < taps.size(); t += 2) {
      const Vector left = Vector::load(middle + taps[t].offset);
      const Vector right = Vector::load(middle + taps[t + 1].offset);
      const float* const weight = taps[t + 1].weight;
      sum[0] += weight[0] * (right + left);
      sum[1] += weight[1] * (right - left);
      if constexpr (Order == 2) {
        sum[2] += weight[2] * (right + left);
      }
    }
    for (int power = 0; power <= Order; ++power) {
      sum[power].store(row_summed(row, power) + i);
    }
  }

  void sum_column(const Taps& taps, int j, int i, float* plane) {
    Vector sum[in_plane] = {};
    const auto load = [&](const Tap& tap, int power) {
      return Vector::load(row_summed(j + layout_.radius.y + tap.offset, power) + i);
    };
    const std::size_t alone = kernel_.straight ? 1 : taps.size();
    for (std::size_t t = 0; t < alone; ++t) {
      const Tap& tap = taps[t];
      const Vector one = load(tap, 0);
      const Vector p = load(tap, 1);
      sum[0] += tap.weight[0] * one;
      sum[1] += tap.weight[0] * p;
      sum[2] += tap.weight[1] * one;
      if constexpr (Order == 2) {
        sum[3] += tap.weight[0] * load(tap, 2);
        sum[4] += tap.weight[1] * p;
        sum[5] += tap.weight[2] * one;
      }
    }
    for (std::size_t t = alone; t + 1 < taps.size(); t += 2) {
      const Tap& left = taps[t];
      const Tap& right = taps[t + 1];
      const Vector even = load(right, 0) + load(left, 0);
      const Vector odd = load(right, 0) - load(left, 0);
      sum[0] += right.weight[0] * even;
      sum[1] += right.weight[0] * (load(right, 1) + load(left, 1));
      sum[2] += right.weight[1] * odd;
      if constexpr (Order == 2) {
        sum[3] += right.weight[0] * (load(right, 2) + load(left, 2));
        sum[4] += right.weight[1] * (load(right, 1) - load(left, 1));
        sum[5] += right.weight[2] * even;
      }
    }
    for (int n = 0; n < in_plane; ++n) {
      sum[n].store(plane + n * layout_.plane() + static_cast<std::size_t>(j) * width() + static_cast<std::size_t>(i));
    }
  }

  void add_straight(const std::vector<Contribution>& contributions, float* out) const {
    const std::size_t size = layout_.plane();
    for (std::size_t n = 0; n < size; n += Lanes) {
      Vector s[in_space] = {};
      for (std::size_t c = 0; c < contributions.size(); ++c) {
        if (contributions[c].paired) {
          add_pair(contributions[c], contributions[c + 1], n, s);
          ++c;
        } else {
          add_slice(contributions[c], n, s);
        }
      }
      for (int m = 0; m < in_space; ++m) {
        s[m].store(out + m * size + n);
      }
    }
  }

  void add_slice(const Contribution& c, std::size_t n, Vector (&s)[in_space]) const {
    const std::size_t size = layout_.plane();
    const float* const b = plane_of(c.slice - layout_.first_slice) + n;
    const Vector one = Vector::load(b);
    const Vector p = Vector::load(b + size);
    const Vector q = Vector::load(b + 2 * size);
    const float w = c.weight;
    const float wz = w * c.offset[2];
    s[0] += w * one;
    s[1] += w * p;
    s[2] += w * q;
    s[3] += wz * one;
    if constexpr (Order == 2) {
      s[4] += w * Vector::load(b + 3 * size);
      s[5] += w * Vector::load(b + 4 * size);
      s[6] += w * Vector::load(b + 5 * size);
      s[7] += wz * p;
      s[8] += wz * q;
      s[9] += (wz * c.offset[2]) * one;
    }
  }

  /// Two slices at equal distances on both sides.
  void add_pair(const Contribution& below, const Contribution& above, std::size_t n, Vector (&s)[in_space]) const {
    const std::size_t size = layout_.plane();
    const float* const b = plane_of(below.slice - layout_.first_slice) + n;
    const float* const a = plane_of(above.slice - layout_.first_slice) + n;
    const auto even = [&](std::size_t m) { return Vector::load(a + m * size) + Vector::load(b + m * size); };
    const auto odd = [&](std::size_t m) { return Vector::load(a + m * size) - Vector::load(b + m * size); };
    const float w = above.weight;
    const float wz = w * above.offset[2];
    s[0] += w * even(0);
    s[1] += w * even(1);
    s[2] += w * even(2);
    s[3] += wz * odd(0);
    if constexpr (Order == 2) {
      s[4] += w * even(3);
      s[5] += w * even(4);
      s[6] += w * even(5);
      s[7] += wz * odd(1);
      s[8] += wz * odd(2);
      s[9] += (wz * above.offset[2]) * even(0);
    }
  }

  /// Shifts a slice's sums from its own origin to that of the current slice, and adds them.
  void add_shifted(const Contribution& c, float* out) const {
    const std::size_t size = layout_.plane();
    const float w = c.weight;
    const float x = c.offset[0];
    const float y = c.offset[1];
    const float z = c.offset[2];
    for (std::size_t n = 0; n < size; n += Lanes) {
      const float* const b = planes_ + n;
      float* const s = out + n;
      const Vector one = Vector::load(b);
      const Vector p = Vector::load(b + size) + x * one;
      const Vector q = Vector::load(b + 2 * size) + y * one;
      add(s, w * one);
      add(s + size, w * p);
      add(s + 2 * size, w * q);
      add(s + 3 * size, w * (z * one));
      if constexpr (Order == 2) {
        const Vector pp = Vector::load(b + 3 * size) + x * (Vector::load(b + size) + p);
        const Vector pq = Vector::load(b + 4 * size) + y * Vector::load(b + size) + x * q;
        const Vector qq = Vector::load(b + 5 * size) + y * (Vector::load(b + 2 * size) + q);
        add(s + 4 * size, w * pp);
        add(s + 5 * size, w * pq);
        add(s + 6 * size, w * qq);
        add(s + 7 * size, w * (z * p));
        add(s + 8 * size, w * (z * q));
        add(s + 9 * size, w * (z * (z * one)));
      }
    }
  }

  static void add(float* sums, const Vector& more) { (Vector::load(sums) + more).store(sums); }

  const SliceKernel& kernel_;
  const BlockLayout& layout_;
  const LoadRow& load_row_;
  float* row_;
  float* rows_summed_;
  float* planes_;
};

}  // namespace palpate::io::internal
