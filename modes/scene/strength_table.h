#pragma once

/// A transfer function in the form for the tick: O(1) for any number of nodes.

#include <cstdint>
#include <span>
#include <vector>

#include "modes/scene/transfer_function.h"

namespace palpate::modes {

/// Differs from its transfer function by at most 1e-12 of the largest node value, for both interpolations.
class StrengthTable {
 public:
  StrengthTable() = default;
  explicit StrengthTable(const TransferFunction& function);

  /// In the tick: does not allocate or throw. NaN gives the value of the first node.
  double operator()(double at) const noexcept;
  /// Multiplies each product by the value at its datum. Returns false if all products would be zero; then the products
  /// may be left unchanged.
  bool multiply(std::span<const double> at, std::span<double> products) const noexcept;
  /// Returns `bits` without those of the data at which the value is zero. The lowest bit is that of the first datum;
  /// there are at most 64 data.
  std::uint64_t not_zero(std::span<const double> at, std::uint64_t bits) const noexcept;

 private:
  double look_up(double at) const noexcept;
  struct Piece {
    double from = 0;                        ///< datum at the piece's start
    double c0 = 0, c1 = 0, c2 = 0, c3 = 0;  ///< value = c0 + c1 d + c2 d^2 + c3 d^3, d = datum - from
  };
  double before_ = 0, beyond_ = 0;  ///< values at the first and the last node
  double first_ = 0, last_ = 0;
  double cells_per_unit_ = 0;
  std::vector<Piece> pieces_;
  std::vector<std::uint32_t> piece_at_;  ///< for each cell of an even grid, the piece at the cell's start
};

}  // namespace palpate::modes
