#include "io/volume.h"

#include <algorithm>
#include <limits>
#include <span>
#include <type_traits>

#include "io/for_processor.h"
#include "io/parallel.h"

namespace palpate::io {

double Volume::value_at(int i, int j, int k) const noexcept {
  const std::size_t at = offset(i, j, k);
  return slope * std::visit([at](const auto& v) { return static_cast<double>(v[at]); }, voxels) + intercept;
}

bool Volume::is_padding(int i, int j, int k) const noexcept {
  if (!padding) return false;
  const std::size_t at = offset(i, j, k);
  const double stored = std::visit([at](const auto& v) { return static_cast<double>(v[at]); }, voxels);
  return stored >= padding->first && stored <= padding->second;
}

namespace {

/// Of at most 2^15 whole numbers.
template <typename Stored>
struct Extent {
  Stored low = std::numeric_limits<Stored>::max();
  Stored high = std::numeric_limits<Stored>::lowest();
  std::conditional_t<std::is_signed_v<Stored>, std::int32_t, std::uint32_t> sum = 0;
};

template <typename Stored>
[[gnu::always_inline]] inline Extent<Stored> extent_in(std::span<const Stored> voxels) {
  Extent<Stored> extent;
  for (const Stored v : voxels) {
    extent.low = std::min(extent.low, v);
    extent.high = std::max(extent.high, v);
    extent.sum += v;
  }
  return extent;
}

PALPATE_FOR_PROCESSOR
Extent<std::int16_t> extent_of(std::span<const std::int16_t> voxels) {
  return extent_in(voxels);
}

PALPATE_FOR_PROCESSOR
Extent<std::uint16_t> extent_of(std::span<const std::uint16_t> voxels) {
  return extent_in(voxels);
}

using Padding = std::optional<std::pair<double, double>>;

/// For stored values: exact if they are integers.
template <typename Stored>
struct Tally {
  static constexpr bool is_whole = std::is_integral_v<Stored>;
  Stored low = std::numeric_limits<Stored>::max();
  Stored high = std::numeric_limits<Stored>::lowest();
  std::conditional_t<is_whole, std::int64_t, double> sum = 0;
  std::uint64_t count = 0;

  void add(std::span<const Stored> voxels, const Padding& left_out) {
    if constexpr (is_whole) {
      if (!left_out) return add_whole(voxels);
    }
    for (const Stored v : voxels) {
      if (left_out && v >= left_out->first && v <= left_out->second) continue;
      low = std::min(low, v);
      high = std::max(high, v);
      sum += v;
      ++count;
    }
  }
  void add_whole(std::span<const Stored> voxels) {
    constexpr std::size_t most = 1U << 15;  // whose sum is a 32-bit number
    for (std::size_t first = 0; first < voxels.size(); first += most) {
      const auto block = voxels.subspan(first, std::min(most, voxels.size() - first));
      const Extent<Stored> extent = extent_of(block);
      low = std::min(low, extent.low);
      high = std::max(high, extent.high);
      sum += extent.sum;
    }
    count += voxels.size();
  }
  void add(const Tally& other) {
    low = std::min(low, other.low);
    high = std::max(high, other.high);
    sum += other.sum;
    count += other.count;
  }
};

template <typename Stored>
Statistics statistics_of(std::span<const Stored> voxels, const Volume& volume, const Padding& left_out) {
  // Always the same pieces, so that the mean does not depend on the number of threads.
  constexpr std::size_t piece = std::size_t{1} << 20;
  std::vector<Tally<Stored>> tallies((voxels.size() + piece - 1) / piece);
  const auto count_piece = [&](std::size_t n) {
    tallies[n].add(voxels.subspan(n * piece, std::min(piece, voxels.size() - n * piece)), left_out);
  };
  internal::parallel_for(tallies.size(), count_piece, {}, 0);
  Tally<Stored> all;
  for (const Tally<Stored>& tally : tallies) all.add(tally);
  if (all.count == 0) return {};
  const double mean = static_cast<double>(all.sum) / static_cast<double>(all.count);
  const auto rescaled = [&](double stored) { return volume.slope * stored + volume.intercept; };
  const auto [minimum, maximum] = std::minmax({rescaled(all.low), rescaled(all.high)});  // a slope may be negative
  return {minimum, maximum, rescaled(mean), all.count};
}

}  // namespace

Statistics statistics(const Volume& volume) {
  const bool is_marked = std::holds_alternative<std::vector<float>>(volume.voxels);  // padding has no value of its own
  const Padding left_out = is_marked ? volume.padding : std::nullopt;
  return std::visit([&](const auto& voxels) { return statistics_of(std::span(voxels), volume, left_out); },
                    volume.voxels);
}

Statistics statistics_without_padding(const Volume& volume) {
  return std::visit([&](const auto& voxels) { return statistics_of(std::span(voxels), volume, volume.padding); },
                    volume.voxels);
}

Statistics merge(const Statistics& a, const Statistics& b) noexcept {
  if (a.count == 0) return b;
  if (b.count == 0) return a;
  const auto count = a.count + b.count;
  const double mean = a.mean + (b.mean - a.mean) * (static_cast<double>(b.count) / static_cast<double>(count));
  return {std::min(a.minimum, b.minimum), std::max(a.maximum, b.maximum), mean, count};
}

}  // namespace palpate::io
