#include "io/fields/padding_map.h"

#include <algorithm>
#include <cstring>

#include "io/fields/padded_rows.h"

namespace palpate::io::internal {
namespace {

/// The type of a voxel in a row: a value, padding, or (beyond the volume) neither.
enum Mark : std::uint8_t { value = 0, padding = 1, neither = 2 };

/// Eight marks at a time.
constexpr std::uint64_t lowest_bits = 0x0101010101010101;

struct Found {
  bool padding = false, values = false;
};

/// What there is among `count` marks, at least eight.
Found look_at(const std::uint8_t* marks, int count) {
  std::uint64_t padding = 0, values = 0;
  for (int n = 0; n < count; n += 8) {
    std::uint64_t eight = 0;
    std::memcpy(&eight, marks + std::min(n, count - 8), 8);
    padding |= eight & lowest_bits;
    values |= ~(eight | eight >> 1) & lowest_bits;
  }
  return {padding != 0, values != 0};
}

/// The marks of a row of the volume.
template <typename Stored>
class MarkReader {
 public:
  MarkReader(const Volume& volume, const std::vector<Stored>& voxels, Mark beyond)
      : volume_(volume), voxels_(voxels.data()), padding_(volume), beyond_(beyond) {}

  /// Whether there is padding.
  bool operator()(int slice, int j, int i, int count, std::uint8_t* marks) const {
    const glm::ivec3 size = volume_.geometry.dimensions;
    const int first = std::clamp(-i, 0, count);
    const int last = j < 0 || j >= size.y ? first : std::clamp(size.x - i, first, count);
    std::fill(marks, marks + first, beyond_);
    std::fill(marks + last, marks + count, beyond_);
    bool any = beyond_ == padding && last - first < count;
    if (!padding_.possible()) {
      std::fill(marks + first, marks + last, value);
    } else if (first < last) {
      any |= mark_padding(voxels_ + volume_.offset(i + first, j, slice), last - first, padding_, marks + first);
    }
    return any;
  }

  /// Whether it would write these marks, which are of the same row of another slice.
  bool agrees(int slice, int j, int i, int count, const std::uint8_t* marks) const {
    const glm::ivec3 size = volume_.geometry.dimensions;
    const int first = std::clamp(-i, 0, count);
    const int last = j < 0 || j >= size.y ? first : std::clamp(size.x - i, first, count);
    return first == last || !padding_.possible() ||
           has_marks(voxels_ + volume_.offset(i + first, j, slice), last - first, padding_, marks + first);
  }

 private:
  const Volume& volume_;
  const Stored* voxels_;
  StoredPadding<Stored> padding_;
  Mark beyond_;
};

/// each[j] = all of of_row[j ... j + reach].
void join_rows(const std::vector<Chunks>& of_row, int reach, int rows, Chunks* each) {
  for (int j = 0; j < rows; ++j) {
    each[j] = 0;
    for (int r = j; r <= j + reach; ++r) each[j] |= of_row[static_cast<std::size_t>(r)];
  }
}

}  // namespace

bool PaddingMap::is_needed(const Volume& volume, const Fits& fits) {
  const auto possible = [&](const auto& voxels) {
    return StoredPadding<typename std::decay_t<decltype(voxels)>::value_type>(volume).possible();
  };
  return !fits.knows_edges() || std::visit(possible, volume.voxels);
}

PaddingMap::PaddingMap(const Volume& volume, const SliceKernel& kernel, const Fits& fits, const Block& tile)
    : kernel_(kernel),
      fits_(fits),
      tile_(tile),
      first_slice_(std::max(tile.first.z - kernel.radius.z, 0)),
      slices_(std::min(tile.first.z + tile.size.z + kernel.radius.z, volume.geometry.dimensions.z) - first_slice_),
      padding_(at(slices_, 0)),
      values_(padding_.size()),
      padded_as_before_(static_cast<std::size_t>(slices_)),
      row_values_(static_cast<std::size_t>(slices_) * static_cast<std::size_t>(tile.size.y + 2 * kernel.radius.y)),
      beside_(at(tile.size.z, 0)),
      valued_(beside_.size()),
      needed_(padding_.size()),
      as_before_(static_cast<std::size_t>(tile.size.z)) {
  std::visit([&](const auto& voxels) { read(volume, voxels); }, volume.voxels);
  find_beside();
}

template <typename Stored>
void PaddingMap::read(const Volume& volume, const std::vector<Stored>& voxels) {
  const MarkReader<Stored> reader(volume, voxels, fits_.knows_edges() ? neither : padding);
  const glm::ivec3 reach = kernel_.radius;
  const int chunks = (tile_.size.x + chunk_width - 1) / chunk_width;
  const int count = tile_.size.x + 2 * reach.x;
  const int rows = tile_.size.y + 2 * reach.y;
  // The last chunk may reach beyond the tile, where nothing counts.
  const auto width = static_cast<std::size_t>(chunks * chunk_width + 2 * reach.x);
  std::vector<std::uint8_t> marks(width * static_cast<std::size_t>(rows), neither);
  std::vector<Chunks> padding_of_row(static_cast<std::size_t>(rows)), values_of_row(padding_of_row.size());
  const Chunks all = ~Chunks{0} >> (32 - chunks);
  for (int n = 0; n < slices_; ++n) {
    bool alike = n > 0;
    for (int r = 0; r < rows; ++r) {
      std::uint8_t* const row = marks.data() + width * static_cast<std::size_t>(r);
      const auto at_row = static_cast<std::size_t>(r);
      const int j = tile_.first.y + r - reach.y, i = tile_.first.x - reach.x;
      if (n > 0 && reader.agrees(first_slice_ + n, j, i, count, row)) continue;  // the row's chunks are as before
      alike = false;
      const bool any = reader(first_slice_ + n, j, i, count, row);
      met_padding_ = met_padding_ || any;
      padding_of_row[at_row] = 0;
      values_of_row[at_row] = all;
      for (int c = 0; any && c < chunks; ++c) {
        const Found found = look_at(row + c * chunk_width, chunk_width + 2 * reach.x);
        padding_of_row[at_row] |= found.padding ? Chunks{1} << c : 0;
        values_of_row[at_row] &= found.values ? all : ~(Chunks{1} << c);
      }
    }
    padded_as_before_[static_cast<std::size_t>(n)] = alike;
    join_rows(padding_of_row, 2 * reach.y, tile_.size.y, &padding_[at(n, 0)]);
    join_rows(values_of_row, 2 * reach.y, tile_.size.y, &values_[at(n, 0)]);
    std::ranges::copy(values_of_row, row_values_.begin() + static_cast<std::ptrdiff_t>(n) * rows);
  }
}

void PaddingMap::find_beside() {
  for (int k = 0; k < tile_.size.z; ++k) {
    const int slice = tile_.first.z + k;
    const auto& contributions = kernel_.of_slice[static_cast<std::size_t>(slice)];
    bool as_before = k > 0 && fits_.alike(slice - 1, slice);
    for (const Contribution& c : contributions) {
      as_before = as_before && padded_as_before_[static_cast<std::size_t>(c.slice - first_slice_)];
    }
    as_before_[static_cast<std::size_t>(k)] = as_before;
    for (int j = 0; j < tile_.size.y; ++j) {
      Chunks padding = 0, values = 0;
      for (const Contribution& c : contributions) {
        padding |= padding_[at(c.slice - first_slice_, j)];
        values |= values_[at(c.slice - first_slice_, j)];
      }
      beside_[at(k, j)] = padding & values;
      valued_[at(k, j)] = values;
      any_ = any_ || (padding & values) != 0;
      if (as_before || (padding & values) == 0) continue;
      for (const Contribution& c : contributions) needed_[at(c.slice - first_slice_, j)] |= padding & values;
    }
  }
}

}  // namespace palpate::io::internal
