#pragma once

/// The plane fits of a tile's voxels that have padding in their neighborhoods (padding_map.h): from the weights of the
/// valid voxels, with the same bits as fit_plane() on the sums of moments.h.

#include <vector>

#include "io/fields/fits.h"
#include "io/fields/lines.h"
#include "io/fields/padding_map.h"
#include "io/fields/row_reader.h"
#include "io/fields/slice_kernel.h"
#include "io/fields/weight_sums.h"

namespace palpate::io::internal {

class PaddedFits {
 public:
  /// `rows`: of the largest tile. `planes`: how many of the latest slices' sums are kept.
  PaddedFits(const SliceKernel& kernel, const Fits& fits, int rows, int planes);

  void start(const Block& tile, const PaddingMap& map);
  /// Sums a slice's weights in its plane, where needed. Slices must be added in ascending order.
  template <typename Stored>
  void add_plane(const RowReader<Stored>& weights, int slice);
  /// The fits of the voxels in PaddingMap::beside() of row j of slice k, both counted from the tile's first; rows as in
  /// straight_sums.h. To be called for each row of the tile with such voxels, slice by slice, after adding all planes
  /// that slice k needs.
  const float* of_row(int k, int j);

 private:
  float* plane_row(int slice, int j) const;
  Chunks needed_in_row(int slice, int r) const;

  const SliceKernel& kernel_;
  const Fits& fits_;
  int planes_count_;
  std::size_t rows_;
  const PaddingMap* map_ = nullptr;
  Block tile_;
  std::vector<float> row_;
  Lines rows_summed_, planes_, sums_, row_fits_;
  std::vector<WeightPair> pairs_;
};

}  // namespace palpate::io::internal
