#pragma once

/// Prepares a volume's rows for the gradient's kernel.

#include <algorithm>
#include <type_traits>
#include <vector>

#include "io/fields/padded_rows.h"
#include "io/padding.h"
#include "io/volume.h"

namespace palpate::io::internal {

/// Reads rows of a volume as stored values, or as 1 where there is a value: 0 beyond the volume and in padding.
template <typename Stored>
class RowReader {
 public:
  /// has_padding: false if the rows to be read are known to hold none.
  RowReader(const Volume& volume, const std::vector<Stored>& voxels, bool mask, bool has_padding = true)
      : volume_(volume),
        voxels_(voxels.data()),
        padding_(volume),
        has_padding_(has_padding && padding_.possible()),
        mask_(mask) {}

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
  /// Prefetches a row that will be read soon.
  void prefetch(int slice, int j, int i, int count) const noexcept {
    const glm::ivec3 size = volume_.geometry.dimensions;
    if (j < 0 || j >= size.y) return;
    const int first = std::max(i, 0);
    const Stored* const row = voxels_ + volume_.offset(0, j, slice);
    for (int n = first; n < std::min(i + count, size.x); n += line) __builtin_prefetch(row + n);
  }
  /// Whether everything read so far was inside the volume and free of padding.
  bool complete() const noexcept { return complete_; }
  bool met_padding() const noexcept { return met_padding_; }

 private:
  static constexpr int line = 64 / sizeof(Stored);  ///< voxels in one cache line

  void copy(const Stored* stored, int count, float* row) const noexcept {
    if (!has_padding_) {
      if (mask_) {
        std::fill(row, row + count, 1.0F);
      } else if constexpr (std::is_integral_v<Stored>) {
        to_floats(stored, count, row);
      } else {
        std::copy(stored, stored + count, row);
      }
      return;
    }
    const bool any = mask_ ? to_weights(stored, count, padding_, row) : to_floats(stored, count, padding_, row);
    met_padding_ = met_padding_ || any;
    complete_ = complete_ && !any;
  }

  const Volume& volume_;
  const Stored* voxels_;
  StoredPadding<Stored> padding_;
  bool has_padding_, mask_;
  mutable bool complete_ = true;
  mutable bool met_padding_ = false;
};

}  // namespace palpate::io::internal
