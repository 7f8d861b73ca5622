#include "modes/scene/strength_table.h"

#include <algorithm>
#include <bit>

namespace palpate::modes {
namespace {

// Cells of the even grid for each piece: with nodes spread evenly, one cell holds at most one node, and a look-up is
// one step.
constexpr std::size_t cells_per_piece = 4;
// Bounds the memory of a very long function; a look-up then walks a few pieces.
constexpr std::size_t most_cells = 1U << 16U;

}  // namespace

StrengthTable::StrengthTable(const TransferFunction& function) {
  const auto nodes = function.nodes();
  if (nodes.empty()) {
    return;
  }
  before_ = nodes.front().value;
  beyond_ = nodes.back().value;
  first_ = nodes.front().at;
  last_ = nodes.back().at;
  if (nodes.size() == 1) {
    return;
  }
  const auto slopes = function.slopes();
  for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
    const double width = nodes[i + 1].at - nodes[i].at;
    const double slope = (nodes[i + 1].value - nodes[i].value) / width;
    Piece piece{nodes[i].at, nodes[i].value, slope, 0.0, 0.0};
    if (!slopes.empty()) {
      piece.c1 = slopes[i];
      piece.c2 = (3.0 * slope - 2.0 * slopes[i] - slopes[i + 1]) / width;
      piece.c3 = (slopes[i] + slopes[i + 1] - 2.0 * slope) / (width * width);
    }
    pieces_.push_back(piece);
  }
  const std::size_t cells = std::min(cells_per_piece * pieces_.size(), most_cells);
  cells_per_unit_ = static_cast<double>(cells) / (last_ - first_);
  std::size_t piece = 0;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const double start = first_ + static_cast<double>(cell) / cells_per_unit_;
    while (piece + 1 < pieces_.size() && pieces_[piece + 1].from <= start) {
      ++piece;
    }
    piece_at_.push_back(static_cast<std::uint32_t>(piece));
  }
}

double StrengthTable::operator()(double at) const noexcept {
  if (!(at > first_)) {
    return before_;
  }
  if (at >= last_) {
    return beyond_;
  }
  return look_up(at);
}

bool StrengthTable::multiply(std::span<const double> at, std::span<double> products) const noexcept {
  int inner = 0, beyond = 0;
  for (const double each : at) {
    inner += each > first_ ? 1 : 0;
    beyond += each >= last_ ? 1 : 0;
  }
  if (before_ == 0 && inner == 0) return false;
  const bool all_before = inner == 0, all_beyond = beyond == static_cast<int>(at.size());
  if ((before_ == 1 && all_before) || (beyond_ == 1 && all_beyond)) return true;
  bool any = false;
  for (std::size_t n = 0; n < products.size(); ++n) {
    if (products[n] == 0) continue;
    products[n] *= (*this)(at[n]);
    any = any || products[n] != 0;
  }
  return any;
}

std::uint64_t StrengthTable::not_zero(std::span<const double> at, std::uint64_t bits) const noexcept {
  for (std::uint64_t left = bits; left != 0; left &= left - 1) {
    if ((*this)(at[static_cast<std::size_t>(std::countr_zero(left))]) == 0) bits &= ~(left & (~left + 1));
  }
  return bits;
}

/// Between the first node and the last.
double StrengthTable::look_up(double at) const noexcept {
  const auto cell = std::min(static_cast<std::size_t>((at - first_) * cells_per_unit_), piece_at_.size() - 1);
  std::size_t i = piece_at_[cell];
  // Rounding may put a datum at a cell's edge into the neighbor: look both ways.
  while (i > 0 && at < pieces_[i].from) {
    --i;
  }
  while (i + 1 < pieces_.size() && at >= pieces_[i + 1].from) {
    ++i;
  }
  const Piece& piece = pieces_[i];
  const double d = at - piece.from;
  return piece.c0 + d * (piece.c1 + d * (piece.c2 + d * piece.c3));
}

}  // namespace palpate::modes
