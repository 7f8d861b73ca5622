#pragma once

/// The voxels of a tile that have padding in their neighborhoods and so need plane fits of their own. Rows without
/// padding are decided as a whole; a row with padding is examined in chunks of eight voxels.

#include <algorithm>
#include <bit>
#include <cstdint>
#include <vector>

#include "io/fields/fits.h"
#include "io/fields/slice_kernel.h"
#include "io/fields/straight_sums.h"
#include "io/volume.h"

namespace palpate::io::internal {

/// Bits for the chunks of a tile's row, the first chunk in the lowest bit. A chunk is eight voxels.
using Chunks = std::uint32_t;
inline constexpr int chunk_width = 8;  ///< voxels
static_assert(tile_width == 32 * chunk_width);

/// The range from the first to the last of some chunks; voxels, counted from the tile's first.
struct Span {
  int begin = 0, end = 0;
};
inline Span span_of(Chunks chunks, int width) noexcept {
  if (chunks == 0) return {};
  return {std::min(std::countr_zero(chunks) * chunk_width, width),
          std::min((32 - std::countl_zero(chunks)) * chunk_width, width)};
}

/// Calls use(begin, end) for each stretch of chunks; voxels, counted from the tile's first.
template <typename Use>
void for_each_stretch(Chunks chunks, const Use& use) {
  for (int first = 0; chunks >> first != 0;) {
    first += std::countr_zero(chunks >> first);
    const int count = std::countr_one(chunks >> first);
    use(first * chunk_width, (first + count) * chunk_width);
    first += count;
    if (first == 32) return;
  }
}

/// The map of one tile. If the fits at the volume's edge are not known, the outside of the volume counts as padding.
class PaddingMap {
 public:
  PaddingMap(const Volume& volume, const SliceKernel& kernel, const Fits& fits, const Block& tile);

  /// Whether a tile of this volume can have voxels with padding in their neighborhoods.
  static bool is_needed(const Volume& volume, const Fits& fits);

  /// Whether there is padding within the kernel's reach of the tile.
  bool met_padding() const noexcept { return met_padding_; }
  /// Whether any voxel has padding in its neighborhood.
  bool any() const noexcept { return any_; }
  /// The chunks of row j of slice k (both counted from the tile's first) with both padding and values in their
  /// neighborhoods. Without values no fit is needed, since all sums are 0.
  Chunks beside(int k, int j) const noexcept { return beside_[at(k, j)]; }
  /// The chunks of row j of slice k with any value in their neighborhoods; in the others all sums are 0.
  Chunks valued(int k, int j) const noexcept { return valued_[at(k, j)]; }
  /// The same for the in-plane sums of a slice of the volume.
  Chunks valued_in_plane(int slice, int j) const noexcept { return values_[at(slice - first_slice_, j)]; }
  /// The same for the sums along row r, counted from the first row within the tile's reach.
  Chunks valued_in_row(int slice, int r) const noexcept {
    return row_values_[static_cast<std::size_t>(slice - first_slice_) *
                           static_cast<std::size_t>(tile_.size.y + 2 * kernel_.radius.y) +
                       static_cast<std::size_t>(r)];
  }
  /// Whether the fits of slice k are those of slice k - 1.
  bool as_before(int k) const noexcept { return as_before_[static_cast<std::size_t>(k)]; }
  /// The chunks of row j of a slice of the volume whose sums are needed for the fits of some slice.
  Chunks needed(int slice, int j) const noexcept { return needed_[at(slice - first_slice_, j)]; }

 private:
  std::size_t at(int slice, int j) const noexcept {
    return static_cast<std::size_t>(slice) * static_cast<std::size_t>(tile_.size.y) + static_cast<std::size_t>(j);
  }
  template <typename Stored>
  void read(const Volume& volume, const std::vector<Stored>& voxels);
  void find_beside();

  const SliceKernel& kernel_;
  const Fits& fits_;
  Block tile_;
  int first_slice_ = 0, slices_ = 0;      // within the tile's reach
  std::vector<Chunks> padding_, values_;  // within the reach of a row's chunks, in each of these slices
  std::vector<bool> padded_as_before_;    // whether a slice has its padding at the same places as the slice before
  std::vector<Chunks> row_values_;        // of each row within the tile's reach
  std::vector<Chunks> beside_, valued_, needed_;
  std::vector<bool> as_before_;
  bool met_padding_ = false, any_ = false;
};

}  // namespace palpate::io::internal
