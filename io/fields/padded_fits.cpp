#include "io/fields/padded_fits.h"

#include <algorithm>

#include "io/fields/moments.h"

// Offsets within a tile, far below what an int holds.
// NOLINTBEGIN(bugprone-implicit-widening-of-multiplication-result,bugprone-misplaced-widening-cast)
namespace palpate::io::internal {

static_assert(weight_plane_sums == plane_sums(2) && weight_space_sums == space_sums(2));

PaddedFits::PaddedFits(const SliceKernel& kernel, const Fits& fits, int rows, int planes)
    : kernel_(kernel),
      fits_(fits),
      planes_count_(planes),
      rows_(static_cast<std::size_t>(rows)),
      row_(static_cast<std::size_t>(tile_width + 2 * kernel.radius.x), 0.0F),
      rows_summed_(static_cast<std::size_t>(row_sums * tile_width) *
                   (rows_ + 2 * static_cast<std::size_t>(kernel.radius.y))),
      planes_(static_cast<std::size_t>(planes) * rows_ * weight_plane_sums * tile_width),
      sums_(weight_space_sums * tile_width),
      row_fits_(rows_ * fit_rows * tile_width) {}

void PaddedFits::start(const Block& tile, const PaddingMap& map) {
  tile_ = tile;
  map_ = &map;
}

float* PaddedFits::plane_row(int slice, int j) const {
  return planes_.get() + (static_cast<std::size_t>(slice % planes_count_) * rows_ + static_cast<std::size_t>(j)) *
                             (weight_plane_sums * tile_width);
}

/// The chunks needed by any of the tile's rows to which row r contributes.
Chunks PaddedFits::needed_in_row(int slice, int r) const {
  Chunks needed = 0;
  for (int j = std::max(r - 2 * kernel_.radius.y, 0); j <= std::min(r, tile_.size.y - 1); ++j) {
    needed |= map_->needed(slice, j);
  }
  return needed;
}

template <typename Stored>
void PaddedFits::add_plane(const RowReader<Stored>& weights, int slice) {
  const glm::ivec3 reach = kernel_.radius;
  for (int r = 0; r < tile_.size.y + 2 * reach.y; ++r) {
    float* const summed = rows_summed_.get() + r * (row_sums * tile_width);
    if (const Chunks needed = needed_in_row(slice, r); needed != 0) {
      weights(slice, tile_.first.y + r - reach.y, tile_.first.x - reach.x, tile_.size.x + 2 * reach.x, row_.data());
      for_each_stretch(
          needed, [&](int begin, int end) { weigh_row(row_.data() + reach.x, kernel_.taps_i[0], begin, end, summed); });
    }
    if (const int j = r - 2 * reach.y; j >= 0) {
      for_each_stretch(map_->needed(slice, j), [&](int begin, int end) {
        weigh_column(summed - reach.y * (row_sums * tile_width), kernel_.taps_j[0], begin, end, plane_row(slice, j));
      });
    }
  }
}

template void PaddedFits::add_plane(const RowReader<std::int16_t>&, int);
template void PaddedFits::add_plane(const RowReader<std::uint16_t>&, int);
template void PaddedFits::add_plane(const RowReader<float>&, int);

const float* PaddedFits::of_row(int k, int j) {
  float* const fits = row_fits_.get() + j * (fit_rows * tile_width);
  if (map_->as_before(k)) return fits;
  pairs_.clear();
  const auto& all = kernel_.of_slice[static_cast<std::size_t>(tile_.first.z + k)];
  for (std::size_t n = 0; n < all.size(); ++n) {
    // A pair uses the weight of the slice above, which comes second.
    const Contribution& c = all[n + (all[n].paired ? 1 : 0)];
    WeightPair pair{plane_row(all[n].slice, j), nullptr, c.weight, c.offset[2]};
    if (all[n].paired) {
      pair.above = plane_row(c.slice, j);
      ++n;
    }
    pairs_.push_back(pair);
  }
  for_each_stretch(map_->beside(k, j), [&](int begin, int end) {
    weigh_slices(pairs_.data(), static_cast<int>(pairs_.size()), begin, end, sums_.get());
    fit_planes(sums_.get(), begin, end, fits_.scale_mm(), fits_.to_patient(), fits);
  });
  return fits;
}

}  // namespace palpate::io::internal

// NOLINTEND(bugprone-implicit-widening-of-multiplication-result,bugprone-misplaced-widening-cast)
