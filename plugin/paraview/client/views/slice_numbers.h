#pragma once

/// The displayed number of a slice.

namespace palpate::plugin {

/// The direction in which slices are counted. The scanner's own slices count like its images (Instance Number); slices
/// perpendicular to them count in the direction of the wheel.
struct SliceNumbers {
  bool from_last = false;  ///< the last slice of the lattice is number 1
};

/// The number, from 1, of a slice counted from 0 along the lattice.
constexpr int number_of(const SliceNumbers& numbers, int slice, int slices) {
  return numbers.from_last ? slices - slice : slice + 1;
}

}  // namespace palpate::plugin
