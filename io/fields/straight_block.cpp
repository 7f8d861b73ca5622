#include "io/fields/straight_block.h"

#include <algorithm>
#include <memory>

#include "io/fields/row_reader.h"
#include "io/fields/straight_filters.h"

namespace palpate::io::internal {
namespace {

std::vector<TapPair> pairs_of(const Taps& taps) {
  std::vector<TapPair> pairs;
  for (std::size_t t = 2; t < taps.size(); t += 2) {
    pairs.push_back({taps[t].offset, taps[t].weight[0], taps[t].weight[1]});
  }
  return pairs;
}

template <typename Stored>
class StraightBlock {
 public:
  StraightBlock(const Volume& volume, const std::vector<Stored>& voxels, const SliceKernel& kernel, const Fits& fits,
                const Block& block)
      : volume_(volume),
        kernel_(kernel),
        fits_(fits),
        block_(block),
        reader_(volume, voxels, false),
        along_i_(pairs_of(kernel.taps_i[0])),
        along_j_(pairs_of(kernel.taps_j[0])),
        width_(static_cast<std::ptrdiff_t>(block.size.x + 7) / 8 * 8),
        plane_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(block.size.y) + apart),
        rows_(block.size.y + std::ptrdiff_t{2} * kernel.radius.y),
        ring_(2 * kernel.radius.z + 1),
        row_(static_cast<std::size_t>(width_ + std::ptrdiff_t{2} * kernel.radius.x), 0.0F),
        filtered_(std::make_unique_for_overwrite<float[]>(static_cast<std::size_t>(2 * width_ * rows_))),
        planes_(std::make_unique_for_overwrite<float[]>(3 * plane_ * static_cast<std::size_t>(ring_))),
        sum_(static_cast<std::size_t>(width_) + 16),
        sums_(4 * sum_) {}

  bool run(const GradientTarget& target) {
    int next = std::max(block_.first.z - kernel_.radius.z, 0);
    for (int k = 0; k < block_.size.z; ++k) {
      const int slice = block_.first.z + k;
      const auto& contributions = kernel_.of_slice[static_cast<std::size_t>(slice)];
      int last = 0;
      for (const Contribution& c : contributions) last = std::max(last, c.slice);
      for (; next <= last; ++next) {
        filter_plane(next);
        if (reader_.met_padding() || (!reader_.complete() && !fits_.knows_edges())) return false;
      }
      balanced_ = fits_.whole(slice).constant == glm::vec3(0);
      find_pairs(contributions);
      for (int j = 0; j < block_.size.y; ++j) {
        sum_row();
        fit_row(j, slice, target.first + k * target.slice + j * target.row);
      }
    }
    return true;
  }

 private:
  /// Planes lie a little more than their size apart: as a power of two it would let the same place of all of them
  /// compete for the same few lines of the nearest cache.
  static constexpr std::size_t apart = 80;

  float* plane_of(int slice) { return planes_.get() + 3 * plane_ * static_cast<std::size_t>(slice % ring_); }

  void filter_plane(int slice) {
    const int reach = kernel_.radius.x;
    for (std::ptrdiff_t r = 0; r < rows_; ++r) {
      reader_(slice, block_.first.y + static_cast<int>(r) - kernel_.radius.y, block_.first.x - reach,
              block_.size.x + 2 * reach, row_.data());
      float* const one = filtered_.get() + 2 * width_ * r;
      filter_row(row_.data() + reach, kernel_.taps_i[0][0].weight[0], along_i_.data(),
                 static_cast<int>(along_i_.size()), static_cast<int>(width_), one, one + width_);
    }
    float* const to = plane_of(slice);
    for (int j = 0; j < block_.size.y; ++j) {
      float* const one = to + width_ * j;
      filter_column(filtered_.get() + 2 * width_ * (j + kernel_.radius.y), 2 * width_, kernel_.taps_j[0][0].weight[0],
                    along_j_.data(), static_cast<int>(along_j_.size()), static_cast<int>(width_), one, one + plane_,
                    one + 2 * plane_);
    }
  }

  void find_pairs(const std::vector<Contribution>& contributions) {
    pairs_.clear();
    for (std::size_t n = 0; n < contributions.size(); ++n) {
      // Of a pair the weight is that of the slice above, which comes second.
      const Contribution& c = contributions[n + (contributions[n].paired ? 1 : 0)];
      SlicePair pair{plane_of(contributions[n].slice), nullptr, c.weight, c.weight * c.offset[2]};
      if (contributions[n].paired) {
        pair.above = plane_of(c.slice);
        ++n;
      }
      pairs_.push_back(pair);
    }
  }

  // The row after the one that the pairs point at is theirs next.
  void sum_row() {
    float* const s = sums_.data();
    const bool needs_total = !balanced_ || !reader_.complete();
    sum_slices(pairs_.data(), static_cast<int>(pairs_.size()), plane_, needs_total ? s : nullptr, s + sum_,
               s + 2 * sum_, s + 3 * sum_, static_cast<std::size_t>(width_));
    for (SlicePair& pair : pairs_) {
      pair.below += width_;
      if (pair.above != nullptr) pair.above += width_;
    }
  }

  void fit_row(int j, int slice, glm::vec3* gradients) {
    const glm::ivec3 size = volume_.geometry.dimensions;
    const int y = block_.first.y + j;
    int first = 0;
    int last = block_.size.x;
    if (!reader_.complete()) {
      const bool inner_row = y >= kernel_.radius.y && y < size.y - kernel_.radius.y;
      first = inner_row ? std::clamp(kernel_.radius.x - block_.first.x, 0, last) : last;
      last = inner_row ? std::clamp(size.x - kernel_.radius.x - block_.first.x, first, last) : last;
    }
    const float* const s = sums_.data();
    for (int i = 0; i < first; ++i) fit_voxel(fits_.at(block_.first.x + i, y, slice), s + i, gradients[i]);
    const PlaneFit& whole = fits_.whole(slice);
    if (balanced_) {
      fit_balanced_row(whole.slope, s + sum_ + first, s + 2 * sum_ + first, s + 3 * sum_ + first, last - first,
                       gradients + first);
    } else {
      for (int i = first; i < last; ++i) fit_voxel(whole, s + i, gradients[i]);
    }
    for (int i = last; i < block_.size.x; ++i) {
      fit_voxel(fits_.at(block_.first.x + i, y, slice), s + i, gradients[i]);
    }
  }

  void fit_voxel(const PlaneFit& fit, const float* s, glm::vec3& gradient) const {
    gradient = gradient_of(fit, s, sum_);
  }

  const Volume& volume_;
  const SliceKernel& kernel_;
  const Fits& fits_;
  const Block& block_;
  RowReader<Stored> reader_;
  std::vector<TapPair> along_i_;
  std::vector<TapPair> along_j_;
  std::ptrdiff_t width_;  ///< floats of a row
  std::size_t plane_;     ///< floats of a plane
  std::ptrdiff_t rows_;   ///< that the columns of a slice reach over
  int ring_;              ///< planes kept
  std::vector<float> row_;
  std::unique_ptr<float[]> filtered_;
  std::unique_ptr<float[]> planes_;
  std::vector<SlicePair> pairs_;
  std::size_t sum_;  ///< floats from one of a row's sums to the next
  std::vector<float> sums_;
  bool balanced_ = true;
};

}  // namespace

template <typename Stored>
bool straight_block(const Volume& volume, const std::vector<Stored>& voxels, const SliceKernel& kernel,
                    const Fits& fits, const Block& block, const GradientTarget& target) {
  return StraightBlock<Stored>(volume, voxels, kernel, fits, block).run(target);
}

template bool straight_block(const Volume&, const std::vector<std::int16_t>&, const SliceKernel&, const Fits&,
                             const Block&, const GradientTarget&);
template bool straight_block(const Volume&, const std::vector<std::uint16_t>&, const SliceKernel&, const Fits&,
                             const Block&, const GradientTarget&);
template bool straight_block(const Volume&, const std::vector<float>&, const SliceKernel&, const Fits&, const Block&,
                             const GradientTarget&);

}  // namespace palpate::io::internal
