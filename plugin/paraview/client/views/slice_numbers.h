#pragma once

/// The number that a slice is called by.

namespace palpate::plugin {

/// Which way slices are counted. The scanner's own slices count as its images do (Instance Number); slices that are cut
/// through them count the way the wheel goes.
struct SliceNumbers {
  bool from_last = false;  ///< the last slice of the lattice is number 1
};

/// From 1, of a slice counted from 0 along the lattice.
constexpr int number_of(const SliceNumbers& numbers, int slice, int slices) {
  return numbers.from_last ? slices - slice : slice + 1;
}

}  // namespace palpate::plugin
