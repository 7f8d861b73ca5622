#pragma once

/// A transfer function: from a datum of the scan to a strength in newtons, or to a gate's factor.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace palpate::modes {

struct Node {
  double at = 0;     ///< the datum, in its own unit (HU, HU/mm, the stored unit, ...)
  double value = 0;  ///< N, or a factor
};

enum class Interpolation : std::uint8_t {
  linear,
  monotone_cubic  ///< once differentiable, and never above or below the nodes on both sides (Fritsch and Butland, 1984)
};

/// Exact at its nodes and constant beyond the first and the last. A plain value: copies are independent.
class TransferFunction {
 public:
  /// Zero everywhere.
  TransferFunction() = default;
  /// The same value everywhere.
  explicit TransferFunction(double constant);
  /// At least one node, `at` strictly ascending, all finite. Throws std::invalid_argument that names the node.
  explicit TransferFunction(std::vector<Node> nodes, Interpolation interpolation = Interpolation::linear);

  /// O(log nodes). Does not allocate or throw; NaN gives the value of the first node.
  double operator()(double at) const noexcept;

  std::span<const Node> nodes() const noexcept { return nodes_; }
  /// The slope at each node of the monotone cubic; empty if linear.
  std::span<const double> slopes() const noexcept { return slopes_; }
  Interpolation interpolation() const noexcept { return interpolation_; }
  double minimum() const noexcept;
  double maximum() const noexcept;

 private:
  std::vector<Node> nodes_;
  std::vector<double> slopes_;
  Interpolation interpolation_ = Interpolation::linear;
};

}  // namespace palpate::modes
