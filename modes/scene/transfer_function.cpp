#include "modes/scene/transfer_function.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "modes/messages.h"

namespace palpate::modes {
namespace {

// Within these, the cubic's coefficients cannot overflow.
constexpr double largest = 1e30;
constexpr double least_spacing = 1e-30;

void check(std::span<const Node> nodes) {
  if (nodes.empty()) {
    throw InvalidInput(say("nodes-there-are-none"));
  }
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    const std::string path = "nodes[" + std::to_string(i) + "]";
    if (!(std::abs(nodes[i].at) <= largest) || !(std::abs(nodes[i].value) <= largest)) {
      throw InvalidInput(say("not-a-usable-number", path));
    }
    if (i > 0 && !(nodes[i].at - nodes[i - 1].at >= least_spacing)) {
      throw InvalidInput(say("nodes-do-not-ascend", path));
    }
  }
}

// Fritsch and Butland (1984): the weighted harmonic mean of the slopes on both sides, zero where they differ in sign.
// At the ends zero, so that the function is smooth where it becomes constant.
std::vector<double> monotone_slopes(std::span<const Node> nodes) {
  std::vector<double> slopes(nodes.size(), 0.0);
  for (std::size_t i = 1; i + 1 < nodes.size(); ++i) {
    const double h0 = nodes[i].at - nodes[i - 1].at;
    const double h1 = nodes[i + 1].at - nodes[i].at;
    const double d0 = (nodes[i].value - nodes[i - 1].value) / h0;
    const double d1 = (nodes[i + 1].value - nodes[i].value) / h1;
    if ((d0 > 0 && d1 > 0) || (d0 < 0 && d1 < 0)) {
      slopes[i] = 3.0 * (h0 + h1) / ((2.0 * h1 + h0) / d0 + (h1 + 2.0 * h0) / d1);
    }
  }
  return slopes;
}

}  // namespace

TransferFunction::TransferFunction(double constant) : TransferFunction(std::vector<Node>{{0.0, constant}}) {}

TransferFunction::TransferFunction(std::vector<Node> nodes, Interpolation interpolation)
    : nodes_(std::move(nodes)), interpolation_(interpolation) {
  check(nodes_);
  if (interpolation_ == Interpolation::monotone_cubic) {
    slopes_ = monotone_slopes(nodes_);
  }
}

double TransferFunction::operator()(double at) const noexcept {
  if (nodes_.empty()) {
    return 0.0;
  }
  if (!(at > nodes_.front().at)) {
    return nodes_.front().value;
  }
  if (at >= nodes_.back().at) {
    return nodes_.back().value;
  }
  const auto after =
      std::upper_bound(nodes_.begin(), nodes_.end(), at, [](double x, const Node& node) { return x < node.at; });
  const Node& right = *after;
  const Node& left = *(after - 1);
  const double width = right.at - left.at;
  const double t = (at - left.at) / width;
  const double rise = right.value - left.value;
  if (interpolation_ == Interpolation::linear) {
    return left.value + t * rise;
  }
  const auto i = static_cast<std::size_t>(after - nodes_.begin()) - 1;
  const double m0 = slopes_[i] * width;
  const double m1 = slopes_[i + 1] * width;
  return left.value + t * (m0 + t * ((3.0 * rise - 2.0 * m0 - m1) + t * (m0 + m1 - 2.0 * rise)));
}

double TransferFunction::minimum() const noexcept {
  double least = nodes_.empty() ? 0.0 : nodes_.front().value;
  for (const Node& node : nodes_) {
    least = std::min(least, node.value);
  }
  return least;
}

double TransferFunction::maximum() const noexcept {
  double most = nodes_.empty() ? 0.0 : nodes_.front().value;
  for (const Node& node : nodes_) {
    most = std::max(most, node.value);
  }
  return most;
}

}  // namespace palpate::modes
