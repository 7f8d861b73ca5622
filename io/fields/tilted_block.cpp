#include "io/fields/tilted_block.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "io/fields/lines.h"
#include "io/fields/moments.h"
#include "io/fields/padding_map.h"
#include "io/fields/row_reader.h"
#include "io/fields/straight_sums.h"
#include "io/fields/tilted_sums.h"

// Offsets within a tile, far below what an int holds.
// NOLINTBEGIN(bugprone-implicit-widening-of-multiplication-result,bugprone-misplaced-widening-cast)
namespace palpate::io::internal {
namespace {

/// Whether all slices are summed alike along rows, as where a gantry is tilted about them: then a slice's rows are
/// summed once for all slices that it adds to.
bool share_rows(const SliceKernel& kernel) {
  const auto same = [](const Tap& a, const Tap& b) {
    return a.offset == b.offset && std::equal(a.weight, a.weight + 2, b.weight);
  };
  return std::ranges::all_of(kernel.taps_i,
                             [&](const Taps& taps) { return std::ranges::equal(taps, kernel.taps_i.front(), same); });
}

/// In tiles of tile_width voxels along a row, slice by slice.
template <typename Stored>
class TiltedBlock {
 public:
  TiltedBlock(const Volume& volume, const std::vector<Stored>& voxels, const SliceKernel& kernel, const Fits& fits,
              const Block& block)
      : volume_(volume),
        voxels_(voxels),
        kernel_(kernel),
        fits_(fits),
        tile_(block),
        rows_(block.size.y + 2 * kernel.radius.y),
        ring_(share_rows(kernel) ? 2 * kernel.radius.z + 1 : 0),
        row_(static_cast<std::size_t>(tile_width + 2 * kernel.radius.x), 0.0F),
        rows_summed_(static_cast<std::size_t>(2 * tile_width * rows_) * static_cast<std::size_t>(std::max(ring_, 1))),
        plane_(3 * tile_width),
        sums_(static_cast<std::size_t>(sums_of_row) * static_cast<std::size_t>(block.size.y)),
        row_fits_(fit_rows * tile_width) {
    if (PaddingMap::is_needed(volume, fits)) {
      padded_fits_.emplace(static_cast<std::size_t>(fit_rows * tile_width) * static_cast<std::size_t>(block.size.y));
    }
  }

  void run(const GradientTarget& target) {
    const Block block = tile_;
    for (int i = 0; i < block.size.x; i += tile_width) {
      tile_.first.x = block.first.x + i;
      tile_.size.x = std::min(tile_width, block.size.x - i);
      run_tile({target.first + i, target.row, target.slice});
    }
  }

 private:
  static constexpr int sums_of_row = 4 * tile_width;

  int width() const { return (tile_.size.x + 7) / 8 * 8; }

  void run_tile(const GradientTarget& target) {
    padding_.reset();
    if (padded_fits_) padding_ = std::make_unique<PaddingMap>(volume_, kernel_, fits_, tile_);
    met_padding_ = padding_ && padding_->met_padding();
    if (padding_ && !padding_->any()) padding_.reset();
    known_fits_ = {-1, -1};
    int next = std::max(tile_.first.z - kernel_.radius.z, 0);
    for (int k = 0; k < tile_.size.z; ++k) {
      slice_ = tile_.first.z + k;
      const auto& contributions = kernel_.of_slice[static_cast<std::size_t>(slice_)];
      if (ring_ > 0) {
        int last = 0;
        for (const Contribution& c : contributions) last = std::max(last, c.slice);
        for (; next <= last; ++next) sum_rows(next, kernel_.taps_i[0], rows_of(next));
      }
      add_up(contributions);
      if (padding_ && !padding_->as_before(k)) fit_padded(k);
      for (int j = 0; j < tile_.size.y; ++j) fit_row(k, j, target.first + k * target.slice + j * target.row);
    }
  }

  float* rows_of(int slice) const {
    return rows_summed_.get() +
           static_cast<std::size_t>(slice % ring_) * static_cast<std::size_t>(2 * tile_width * rows_);
  }

  void sum_rows(int slice, const Taps& taps, float* rows) {
    const RowReader<Stored> reader(volume_, voxels_, false, met_padding_);
    const glm::ivec3 reach = kernel_.radius;
    for (int r = 0; r < tile_.size.y + 2 * reach.y; ++r) {
      reader(slice, tile_.first.y + r - reach.y, tile_.first.x - reach.x, tile_.size.x + 2 * reach.x, row_.data());
      sum_tilted_row(row_.data() + reach.x, taps, width(), rows + 2 * tile_width * r);
    }
  }

  /// The sums of slice_.
  void add_up(const std::vector<Contribution>& contributions) {
    std::fill_n(sums_.get(), sums_of_row * tile_.size.y, 0.0F);
    for (const Contribution& c : contributions) {
      const auto taps = static_cast<std::size_t>(c.taps);
      if (ring_ == 0) sum_rows(c.slice, kernel_.taps_i[taps], rows_summed_.get());
      const float* const rows = (ring_ > 0 ? rows_of(c.slice) : rows_summed_.get()) + 2 * tile_width * kernel_.radius.y;
      for (int j = 0; j < tile_.size.y; ++j) {
        sum_tilted_column(rows + 2 * tile_width * j, kernel_.taps_j[taps], width(), plane_.get());
        add_tilted(plane_.get(), c, width(), sums_.get() + sums_of_row * j);
      }
    }
  }

  void fit_row(int k, int j, glm::vec3* gradients) {
    const glm::ivec3 size = volume_.geometry.dimensions;
    const int y = tile_.first.y + j;
    const bool inner = y >= kernel_.radius.y && y < size.y - kernel_.radius.y;
    look_up_fits(inner ? -1 : y);
    const float* const sums = sums_.get() + sums_of_row * j;
    fit_sums(sums, row_fits_.get(), 0, tile_.size.x, gradients);
    if (!padding_) return;
    for_each_stretch(padding_->beside(k, j), [&](int begin, int end) {
      fit_sums(sums, padded_row(j), begin, std::min(end, tile_.size.x), gradients);
    });
  }

  float* padded_row(int j) const { return padded_fits_->get() + fit_rows * tile_width * j; }

  /// The fits of the voxels in slice_ with padding in their neighborhoods, from the sums of moments.h.
  void fit_padded(int k) {
    Chunks any = 0;
    int first = tile_.size.y, last = -1;
    for (int j = 0; j < tile_.size.y; ++j) {
      if (padding_->beside(k, j) == 0) continue;
      any |= padding_->beside(k, j);
      first = std::min(first, j);
      last = j;
    }
    for_each_stretch(any, [&](int begin, int whole_end) {
      const int end = std::min(whole_end, tile_.size.x);
      fit_box(k, {{begin, first, 0}, {end - begin, last - first + 1, 1}});
    });
  }

  /// `box`: counted from the tile's first voxel.
  void fit_box(int k, const Block& box) {
    constexpr int at_once = 8;
    const BlockLayout layout({{tile_.first.x + box.first.x, tile_.first.y + box.first.y, slice_}, box.size}, kernel_,
                             at_once);
    weights_.resize(std::max(weights_.size(), layout.moment_floats(2) + layout.scratch_floats(2)));
    const RowReader<Stored> mask(volume_, voxels_, true);
    BlockSums<2, at_once, RowReader<Stored>>(kernel_, layout, mask, weights_.data() + layout.moment_floats(2))
        .run(weights_.data());
    for (int j = 0; j < box.size.y; ++j) {
      const float* const sums = weights_.data() + layout.at(2, 0, j, 0);
      float* const row = padded_row(box.first.y + j) + box.first.x;
      const Chunks beside = padding_->beside(k, box.first.y + j);
      for (int i = 0; i < box.size.x; ++i) {
        if ((beside >> ((box.first.x + i) / chunk_width) & 1) == 0) continue;
        store(fit_plane(sums + i, layout.plane(), fits_.scale_mm(), fits_.to_patient()), row + i);
      }
    }
  }

  /// The fits of a row's voxels; y: -1 for any row far from the edge.
  void look_up_fits(int y) {
    if (known_fits_ == std::pair(slice_, y)) return;
    known_fits_ = {slice_, y};
    for (int i = 0; i < tile_.size.x; ++i) {
      // Those at an edge that is not known are padding's.
      store(
          fits_.knows_edges() ? fits_.at(tile_.first.x + i, y < 0 ? kernel_.radius.y : y, slice_) : fits_.whole(slice_),
          row_fits_.get() + i);
    }
  }

  static void store(const PlaneFit& fit, float* to) {
    for (int n = 0; n < fit_rows; ++n) to[n * tile_width] = n < 9 ? fit.slope[n / 3][n % 3] : fit.constant[n - 9];
  }

  const Volume& volume_;
  const std::vector<Stored>& voxels_;
  const SliceKernel& kernel_;
  const Fits& fits_;
  Block tile_;
  int rows_;  ///< of a tile, with the kernel's reach
  int ring_;  ///< slices whose rows of sums are kept; 0 if none can be shared
  std::vector<float> row_;
  Lines rows_summed_, plane_, sums_, row_fits_;
  std::optional<Lines> padded_fits_;     ///< where the volume can hold padding
  std::unique_ptr<PaddingMap> padding_;  ///< where the tile does
  bool met_padding_ = false;
  std::vector<float> weights_;
  std::pair<int, int> known_fits_{-1, -1};
  int slice_ = 0;
};

}  // namespace

template <typename Stored>
void tilted_block(const Volume& volume, const std::vector<Stored>& voxels, const SliceKernel& kernel, const Fits& fits,
                  const Block& block, const GradientTarget& target) {
  TiltedBlock<Stored>(volume, voxels, kernel, fits, block).run(target);
}

template void tilted_block(const Volume&, const std::vector<std::int16_t>&, const SliceKernel&, const Fits&,
                           const Block&, const GradientTarget&);
template void tilted_block(const Volume&, const std::vector<std::uint16_t>&, const SliceKernel&, const Fits&,
                           const Block&, const GradientTarget&);
template void tilted_block(const Volume&, const std::vector<float>&, const SliceKernel&, const Fits&, const Block&,
                           const GradientTarget&);

}  // namespace palpate::io::internal

// NOLINTEND(bugprone-implicit-widening-of-multiplication-result,bugprone-misplaced-widening-cast)
