#include "io/fields/straight_block.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "io/fields/lines.h"
#include "io/fields/padded_fits.h"
#include "io/fields/padding_map.h"
#include "io/fields/row_reader.h"
#include "io/fields/straight_sums.h"

// Offsets within a tile, far below what an int holds.
// NOLINTBEGIN(bugprone-implicit-widening-of-multiplication-result,bugprone-misplaced-widening-cast)
namespace palpate::io::internal {
namespace {

std::vector<TapPair> pairs_of(const Taps& taps) {
  std::vector<TapPair> pairs;
  for (std::size_t t = 2; t < taps.size(); t += 2) {
    pairs.push_back({taps[t].weight[0], taps[t].weight[1]});
  }
  return pairs;
}

/// Computes a block in tiles of tile_width voxels along a row, slice by slice, so that shared data of a tile stay in
/// the nearest caches.
template <typename Stored>
class StraightBlock {
 public:
  StraightBlock(const Volume& volume, const std::vector<Stored>& voxels, const SliceKernel& kernel, const Fits& fits,
                const Block& block)
      : volume_(volume),
        voxels_(voxels),
        kernel_(kernel),
        fits_(fits),
        tile_(block),
        along_i_(pairs_of(kernel.taps_i[0])),
        along_j_(pairs_of(kernel.taps_j[0])),
        plane_(static_cast<std::size_t>(3 * tile_width * block.size.y) + apart),
        ring_(2 * kernel.radius.z + slices_at_once),
        row_(static_cast<std::size_t>(tile_width + 2 * kernel.radius.x), 0.0F),
        rows_summed_(static_cast<std::size_t>(2 * tile_width) *
                     static_cast<std::size_t>(block.size.y + 2 * kernel.radius.y)),
        planes_(plane_ * static_cast<std::size_t>(ring_)),
        sums_(4 * tile_width),
        row_fits_(fit_rows * tile_width) {
    if (PaddingMap::is_needed(volume, fits)) padded_fits_.emplace(kernel, fits, block.size.y, ring_);
  }

  void run(const GradientTarget& target) {
    const Block block = tile_;
    const int tiles = (block.size.x + tile_width - 1) / tile_width;
    const int width = (block.size.x + tiles - 1) / tiles;
    const int longest = std::min((width + 15) / 16 * 16, tile_width);
    for (int i = 0; i < block.size.x; i += longest) {
      tile_.first.x = block.first.x + i;
      tile_.size.x = std::min(longest, block.size.x - i);
      run_tile({target.first + i, target.row, target.slice});
    }
  }

 private:
  /// Planes lie a little more than their size apart: as a power of two it would let the same place of all of them
  /// compete for the same few lines of the nearest cache.
  static constexpr std::size_t apart = 80;
  static constexpr int row_floats = 3 * tile_width;

  /// That are read ahead of the one in hand: where rows are cut into tiles, the processor does not see that coming.
  static constexpr int rows_ahead = 8;

  static int whole_lanes(int count) { return (count + 7) / 8 * 8; }

  void run_tile(const GradientTarget& target) {
    known_fits_ = {-1, -1};
    find_padding();
    const RowReader<Stored> values(volume_, voxels_, false, met_padding_), weights(volume_, voxels_, true);
    const glm::ivec3 inner = volume_.geometry.dimensions - kernel_.radius - tile_.size;
    complete_ = tile_.first.x >= kernel_.radius.x && tile_.first.x <= inner.x && tile_.first.y >= kernel_.radius.y &&
                tile_.first.y <= inner.y;
    int next = std::max(tile_.first.z - kernel_.radius.z, 0);
    for (int k = 0; k < tile_.size.z; k += at_once_) {
      slice_ = tile_.first.z + k;
      find_at_once(tile_.size.z - k);
      int last = 0;
      for (const Contribution& c : contributions(at_once_ - 1)) last = std::max(last, c.slice);
      for (; next <= last; ++next) {
        sum_plane(values, next);
        if (has_beside_) padded_fits_->add_plane(weights, next);
      }
      find_planes();
      for (int j = 0; j < tile_.size.y; ++j) {
        glm::vec3* const gradients = target.first + k * target.slice + j * target.row;
        fit_slices(k, j, gradients, target.slice);
        if (has_beside_) fit_beside_padding(k, j, gradients, target.slice);
      }
    }
  }

  void find_padding() {
    padding_.reset();
    has_beside_ = false;
    if (!padded_fits_) return;
    padding_ = std::make_unique<PaddingMap>(volume_, kernel_, fits_, tile_);
    met_padding_ = padding_->met_padding();
    has_beside_ = padding_->any();
    if (!met_padding_) padding_.reset();
    if (has_beside_) padded_fits_->start(tile_, *padding_);
  }

  const std::vector<Contribution>& contributions(int n) const {
    return kernel_.of_slice[static_cast<std::size_t>(slice_ + n)];
  }

  float* plane_of(int slice) const { return planes_.get() + plane_ * static_cast<std::size_t>(slice % ring_); }

  void sum_plane(const RowReader<Stored>& reader, int slice) {
    const int reach_i = kernel_.radius.x;
    const int reach_j = kernel_.radius.y;
    const int width = whole_lanes(tile_.size.x);
    float* const to = plane_of(slice);
    for (int r = 0; r < tile_.size.y + 2 * reach_j; ++r) {
      const int first = tile_.first.x - reach_i;
      const int count = tile_.size.x + 2 * reach_i;
      reader.prefetch(slice, tile_.first.y + r - reach_j + rows_ahead, first, count);
      float* const summed = rows_summed_.get() + 2 * tile_width * r;
      const Span of_row = padding_ ? span_of(padding_->valued_in_row(slice, r), width) : Span{0, width};
      if (of_row.begin < of_row.end) {
        reader(slice, tile_.first.y + r - reach_j, first, count, row_.data());
        sum_row(row_.data() + reach_i + of_row.begin, kernel_.taps_i[0][0].weight[0], along_i_.data(), reach_i,
                of_row.end - of_row.begin, summed + of_row.begin);
      }
      clear_around(summed, 2, of_row);
      // As soon as the last of a column's rows is there, while they all are in the nearest cache.
      if (const int j = r - 2 * reach_j; j >= 0) {
        const Span of_plane = padding_ ? span_of(padding_->valued_in_plane(slice, j), width) : Span{0, width};
        float* const sums = to + row_floats * j;
        if (of_plane.begin < of_plane.end) {
          sum_column(rows_summed_.get() + 2 * tile_width * (j + reach_j) + of_plane.begin,
                     kernel_.taps_j[0][0].weight[0], along_j_.data(), reach_j, of_plane.end - of_plane.begin,
                     sums + of_plane.begin);
        }
        clear_around(sums, 3, of_plane);
      }
    }
  }

  /// Where no values are within reach, `count` sums of a row are 0.
  void clear_around(float* sums, int count, const Span& valued) const {
    const int width = whole_lanes(tile_.size.x);
    if (valued.begin == 0 && valued.end == width) return;
    for (int n = 0; n < count; ++n, sums += tile_width) {
      std::fill(sums, sums + valued.begin, 0.0F);
      std::fill(sums + valued.end, sums + width, 0.0F);
    }
  }

  /// How many slices from slice_ on may be summed at once, and with which weights.
  void find_at_once(int most) {
    const auto& all = contributions(0);
    between_.clear();
    even_ = fits_.whole(slice_).constant == glm::vec3(0) && all.size() <= 2 * most_even_pairs + 1;
    middle_ = {all[0].weight, all[0].weight * all[0].offset[2]};
    for (std::size_t n = 1; n < all.size() && even_; n += 2) {
      even_ = all[n].paired;
      // A pair uses the weight of the slice above, which comes second.
      if (even_) between_.push_back({all[n + 1].weight, all[n + 1].weight * all[n + 1].offset[2]});
    }
    at_once_ = 1;
    while (even_ && at_once_ < std::min(most, slices_at_once) && fits_.alike(slice_, slice_ + at_once_)) ++at_once_;
    if (at_once_ < slices_at_once) at_once_ = 1;
  }

  void find_planes() {
    around_.clear();
    pairs_.clear();
    const int reach = static_cast<int>(between_.size());
    for (int n = -reach; even_ && n < at_once_ + reach; ++n) around_.push_back(plane_of(slice_ + n));
    const auto& all = contributions(0);
    for (std::size_t n = 0; n < all.size() && !even_; ++n) {
      const Contribution& c = all[n + (all[n].paired ? 1 : 0)];
      SlicePair pair{plane_of(all[n].slice), nullptr, c.weight, c.weight * c.offset[2]};
      if (all[n].paired) {
        pair.above = plane_of(c.slice);
        ++n;
      }
      pairs_.push_back(pair);
    }
  }

  /// The s-th of the slices in hand.
  EvenSlices even_slices(int s, std::ptrdiff_t row) const {
    return {around_.data() + between_.size() + s, row, middle_.even, middle_.odd, between_.data(),
            static_cast<int>(between_.size())};
  }

  /// A row of the slices in hand: 0 if no value is in reach.
  void fit_slices(int k, int j, glm::vec3* gradients, std::ptrdiff_t apart_slices) {
    const Span plain = padding_ ? plain_span(k, j) : Span{0, tile_.size.x};
    if (plain.begin > 0 || plain.end < tile_.size.x) {
      for (int s = 0; s < at_once_; ++s) {
        glm::vec3* const row = gradients + s * apart_slices;
        std::fill(row, row + plain.begin, glm::vec3(0));
        std::fill(row + plain.end, row + tile_.size.x, glm::vec3(0));
      }
    }
    if (plain.begin == plain.end) return;
    const glm::ivec3 size = volume_.geometry.dimensions;
    const int y = tile_.first.y + j;
    const bool inner_row = complete_ || (y >= kernel_.radius.y && y < size.y - kernel_.radius.y);
    // Complete neighborhoods, as far as rows go.
    const int begin = complete_ ? plain.begin : std::clamp(kernel_.radius.x - tile_.first.x, plain.begin, plain.end);
    const int end = complete_ ? plain.end : std::clamp(size.x - kernel_.radius.x - tile_.first.x, begin, plain.end);
    const std::ptrdiff_t row = row_floats * j;
    if (!even_) {
      look_up_fits(inner_row ? -1 : y);
      fit_any_slices(pairs_.data(), static_cast<int>(pairs_.size()), row + plain.begin, row_fits_.get() + plain.begin,
                     plain.end - plain.begin, sums_.get(), gradients + plain.begin);
      return;
    }
    const bool balanced = inner_row && begin < end;
    if (balanced) {
      fit_balanced_slices(even_slices(0, row + plain.begin), at_once_, fits_.whole(slice_).slope,
                          plain.end - plain.begin, gradients + plain.begin, apart_slices);
      if (begin == plain.begin && end == plain.end) return;
    }
    look_up_fits(inner_row ? -1 : y);
    for (int s = 0; s < at_once_; ++s, gradients += apart_slices) {
      const EvenSlices even = even_slices(s, row);
      fit_even_slices(even, row_fits_.get(), plain.begin, balanced ? begin : plain.end, gradients);
      if (balanced) fit_even_slices(even, row_fits_.get(), end, plain.end, gradients);
    }
  }

  /// From the first to the last voxel of row j with values in its neighborhood that is not fit again in all of the
  /// slices in hand.
  Span plain_span(int k, int j) const {
    Chunks valued = 0, again = ~Chunks{0};
    for (int s = 0; s < at_once_; ++s) {
      valued |= padding_->valued(k + s, j);
      again &= padding_->beside(k + s, j);
    }
    return span_of(valued & ~again, tile_.size.x);
  }

  /// Computes the voxels of row j with padding in their neighborhoods again.
  void fit_beside_padding(int k, int j, glm::vec3* gradients, std::ptrdiff_t apart_slices) {
    const std::ptrdiff_t row = row_floats * j;
    for (int s = 0; s < at_once_; ++s, gradients += apart_slices) {
      const Chunks beside = padding_->beside(k + s, j);
      if (beside == 0) continue;
      const float* const fits = padded_fits_->of_row(k + s, j);
      for_each_stretch(beside, [&](int begin, int whole_end) {
        const int end = std::min(whole_end, tile_.size.x);
        if (even_) {
          fit_even_slices(even_slices(s, row), fits, begin, end, gradients);
        } else {
          fit_any_slices(pairs_.data(), static_cast<int>(pairs_.size()), row + begin, fits + begin, end - begin,
                         sums_.get(), gradients + begin);
        }
      });
    }
  }

  /// The fits of a row's voxels, in slices that are alike; y: -1 for any row far from the edge.
  void look_up_fits(int y) {
    if (known_fits_ == std::pair(slice_, y)) return;
    known_fits_ = {slice_, y};
    const bool whole = complete_ || !fits_.knows_edges();  // those at an edge that is not known are padding's
    for (int i = 0; i < tile_.size.x; ++i) {
      const PlaneFit& fit =
          whole ? fits_.whole(slice_) : fits_.at(tile_.first.x + i, y < 0 ? kernel_.radius.y : y, slice_);
      for (int n = 0; n < fit_rows; ++n) {
        row_fits_.get()[n * tile_width + i] = n < 9 ? fit.slope[n / 3][n % 3] : fit.constant[n - 9];
      }
    }
  }

  const Volume& volume_;
  const std::vector<Stored>& voxels_;
  const SliceKernel& kernel_;
  const Fits& fits_;
  Block tile_;
  std::vector<TapPair> along_i_;
  std::vector<TapPair> along_j_;
  std::size_t plane_;  ///< floats of a plane
  int ring_;           ///< planes kept
  std::vector<float> row_;
  Lines rows_summed_;
  Lines planes_;
  Lines sums_;
  Lines row_fits_;
  std::optional<PaddedFits> padded_fits_;  ///< where the volume can hold padding
  std::unique_ptr<PaddingMap> padding_;    ///< where the tile does
  bool met_padding_ = false, has_beside_ = false;
  std::pair<int, int> known_fits_{-1, -1};
  int slice_ = 0;    ///< the first of those in hand
  int at_once_ = 1;  ///< how many these are
  bool even_ = false;
  bool complete_ = false;
  TapPair middle_;
  std::vector<TapPair> between_;      ///< of even slices: weights by distance, and the slice's own before
  std::vector<SlicePair> pairs_;      ///< of other slices
  std::vector<const float*> around_;  ///< of even slices: their planes and their neighbors'
};

}  // namespace

template <typename Stored>
void straight_block(const Volume& volume, const std::vector<Stored>& voxels, const SliceKernel& kernel,
                    const Fits& fits, const Block& block, const GradientTarget& target) {
  StraightBlock<Stored>(volume, voxels, kernel, fits, block).run(target);
}

template void straight_block(const Volume&, const std::vector<std::int16_t>&, const SliceKernel&, const Fits&,
                             const Block&, const GradientTarget&);
template void straight_block(const Volume&, const std::vector<std::uint16_t>&, const SliceKernel&, const Fits&,
                             const Block&, const GradientTarget&);
template void straight_block(const Volume&, const std::vector<float>&, const SliceKernel&, const Fits&, const Block&,
                             const GradientTarget&);

}  // namespace palpate::io::internal

// NOLINTEND(bugprone-implicit-widening-of-multiplication-result,bugprone-misplaced-widening-cast)
