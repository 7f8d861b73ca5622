#include "modes/scene/transfer_function.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "modes/scene/strength.h"
#include "modes/scene/strength_table.h"

namespace palpate::modes {
namespace {

const std::vector<Node> skin{{-500, 0}, {-300, 1}, {-250, 0.25}, {40, 0.25}, {41, 3}};

std::vector<Node> random_nodes(std::mt19937& random) {
  std::uniform_real_distribution<double> step(1e-3, 100), value(0, 5);
  std::vector<Node> nodes{{-1000 + step(random), value(random)}};
  const auto count = std::uniform_int_distribution<int>(0, 30)(random);
  for (int i = 0; i < count; ++i) {
    nodes.push_back({nodes.back().at + step(random), value(random)});
  }
  return nodes;
}

TEST(TransferFunction, is_exact_at_its_nodes_and_constant_beyond_them) {
  for (const Interpolation interpolation : {Interpolation::linear, Interpolation::monotone_cubic}) {
    const TransferFunction function(skin, interpolation);
    for (const Node& node : skin) {
      EXPECT_EQ(function(node.at), node.value);
    }
    EXPECT_EQ(function(-1e9), 0.0);
    EXPECT_EQ(function(-std::numeric_limits<double>::infinity()), 0.0);
    EXPECT_EQ(function(1e9), 3.0);
    EXPECT_EQ(function(std::numeric_limits<double>::infinity()), 3.0);
  }
}

TEST(TransferFunction, is_a_straight_line_between_nodes) {
  const TransferFunction function(skin);
  EXPECT_DOUBLE_EQ(function(-400), 0.5);
  EXPECT_DOUBLE_EQ(function(-275), 0.625);
  EXPECT_DOUBLE_EQ(function(0), 0.25);
}

TEST(TransferFunction, monotone_cubic_never_leaves_the_range_of_its_two_nodes_and_has_no_kink) {
  std::mt19937 random(1);
  for (int trial = 0; trial < 200; ++trial) {
    const auto nodes = random_nodes(random);
    const TransferFunction function(nodes, Interpolation::monotone_cubic);
    for (std::size_t i = 0; i + 1 < nodes.size(); ++i) {
      const auto [low, high] = std::minmax(nodes[i].value, nodes[i + 1].value);
      double previous = nodes[i].value;
      for (int part = 1; part <= 20; ++part) {
        const double value = function(nodes[i].at + (nodes[i + 1].at - nodes[i].at) * part / 20.0);
        EXPECT_GE(value, low - 1e-12);
        EXPECT_LE(value, high + 1e-12);
        EXPECT_GE((value - previous) * (nodes[i + 1].value - nodes[i].value), -1e-12);
        previous = value;
      }
    }
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const double h = 1e-7;
      const double before = (function(nodes[i].at) - function(nodes[i].at - h)) / h;
      const double after = (function(nodes[i].at + h) - function(nodes[i].at)) / h;
      const double narrowest = std::min(i > 0 ? nodes[i].at - nodes[i - 1].at : 1.0,
                                        i + 1 < nodes.size() ? nodes[i + 1].at - nodes[i].at : 1.0);
      EXPECT_NEAR(before, after, 1e-5 + 60 * h / (narrowest * narrowest));  // |f''| <= 12 * 5 / narrowest^2
    }
  }
}

/// The cubic of Hermite with the slopes that the paper gives (F. N. Fritsch, J. Butland, 1984, equation for the
/// weighted harmonic mean, alpha = (1 + h2 / (h1 + h2)) / 3), written as it is there.
double published_cubic(const std::vector<Node>& nodes, double at) {
  const auto slope = [&](std::size_t i) {
    if (i == 0 || i + 1 == nodes.size()) return 0.0;
    const double h1 = nodes[i].at - nodes[i - 1].at, h2 = nodes[i + 1].at - nodes[i].at;
    const double s1 = (nodes[i].value - nodes[i - 1].value) / h1, s2 = (nodes[i + 1].value - nodes[i].value) / h2;
    if (s1 * s2 <= 0) return 0.0;
    const double alpha = (1 + h2 / (h1 + h2)) / 3;
    return s1 * s2 / (alpha * s2 + (1 - alpha) * s1);
  };
  if (at <= nodes.front().at) return nodes.front().value;
  if (at >= nodes.back().at) return nodes.back().value;
  std::size_t i = 0;
  while (nodes[i + 1].at <= at) ++i;
  const double h = nodes[i + 1].at - nodes[i].at, t = (at - nodes[i].at) / h;
  return (1 + 2 * t) * (1 - t) * (1 - t) * nodes[i].value + t * (1 - t) * (1 - t) * h * slope(i) +
         t * t * (3 - 2 * t) * nodes[i + 1].value + t * t * (t - 1) * h * slope(i + 1);
}

TEST(TransferFunction, monotone_cubic_is_the_published_one_between_nodes_unevenly_apart) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 200; ++trial) {
    const auto nodes = random_nodes(random);
    const TransferFunction function(nodes, Interpolation::monotone_cubic);
    for (int n = 0; n < 50; ++n) {
      const double at = std::uniform_real_distribution<double>(nodes.front().at - 5, nodes.back().at + 5)(random);
      EXPECT_NEAR(function(at), published_cubic(nodes, at), 1e-10);
    }
  }
  // By hand: slopes 1 and 1/2 on widths 1 and 2 give 9/13.
  const TransferFunction known({{0, 0}, {1, 1}, {3, 2}}, Interpolation::monotone_cubic);
  EXPECT_NEAR((known(1 + 1e-6) - known(1 - 1e-6)) / 2e-6, 9.0 / 13, 1e-6);
}

TEST(TransferFunction, knows_its_least_and_its_most) {
  std::mt19937 random(5);
  for (int trial = 0; trial < 50; ++trial) {
    const auto nodes = random_nodes(random);
    const TransferFunction function(nodes);
    double least = nodes[0].value, most = nodes[0].value;
    for (const Node& node : nodes) {
      least = std::min(least, node.value);
      most = std::max(most, node.value);
    }
    EXPECT_EQ(function.minimum(), least);
    EXPECT_EQ(function.maximum(), most);
  }
}

TEST(TransferFunction, refuses_unusable_nodes_by_their_index) {
  const auto message = [](std::vector<Node> nodes) {
    try {
      TransferFunction function(std::move(nodes));
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  EXPECT_EQ(message({}).find("nodes"), 0U);
  EXPECT_EQ(message({{0, 1}, {0, 2}}).find("nodes[1]"), 0U);
  EXPECT_EQ(message({{0, 1}, {1, 2}, {0.5, 2}}).find("nodes[2]"), 0U);
  EXPECT_EQ(message({{0, std::nan("")}}).find("nodes[0]"), 0U);
  EXPECT_EQ(message({{std::numeric_limits<double>::infinity(), 1}}).find("nodes[0]"), 0U);
  EXPECT_EQ(message({{0, 1}}), "accepted");
}

TEST(StrengthTable, agrees_with_its_transfer_function) {
  std::mt19937 random(2);
  std::uniform_real_distribution<double> anywhere(-1100, 2500);
  double worst = 0;
  for (int trial = 0; trial < 300; ++trial) {
    const auto interpolation = trial % 2 == 0 ? Interpolation::linear : Interpolation::monotone_cubic;
    const TransferFunction function(random_nodes(random), interpolation);
    const StrengthTable table(function);
    for (const Node& node : function.nodes()) {
      EXPECT_EQ(table(node.at), node.value);
      for (const double beside : {std::nextafter(node.at, -1e9), std::nextafter(node.at, 1e9)}) {
        worst = std::max(worst, std::abs(table(beside) - function(beside)));
      }
    }
    for (int i = 0; i < 300; ++i) {
      const double at = anywhere(random);
      worst = std::max(worst, std::abs(table(at) - function(at)));
    }
  }
  EXPECT_LE(worst, 5e-12);
  // Without nodes it is zero everywhere, with one the same everywhere.
  for (const TransferFunction& function : {TransferFunction(), TransferFunction(2.0), TransferFunction({{7.0, 3.0}})}) {
    const StrengthTable table(function), none;
    for (const double at : {-1e9, -1.0, -1e-9, 0.0, 1e-9, 0.5, 1.0, 1.5, 7.0, 7.5, 1e9}) {
      EXPECT_EQ(table(at), function(at)) << at;
      EXPECT_EQ(none(at), 0) << at;
    }
  }
}

TEST(StrengthTable, never_gives_a_force_that_is_not_finite) {
  const StrengthTable table{TransferFunction(skin)};
  EXPECT_EQ(table(std::nan("")), 0.0);
  EXPECT_EQ(StrengthTable{}(3.0), 0.0);
  EXPECT_EQ(StrengthTable{TransferFunction(2.0)}(std::nan("")), 2.0);
  const StrengthTable extreme{
      TransferFunction({{-1e30, 1e30}, {0, 0}, {1e-30, 1e30}, {1e30, 0}}, Interpolation::monotone_cubic)};
  for (const double at : {-1e30, -1e15, -1.0, 1e-31, 5e-31, 1.0, 1e29}) {
    EXPECT_TRUE(std::isfinite(extreme(at))) << at;
  }
}

/// A function that is zero in places: between some nodes, before the first or beyond the last.
TransferFunction zero_in_places(std::mt19937& random) {
  std::vector<Node> nodes = random_nodes(random);
  for (Node& node : nodes) node.value *= std::uniform_int_distribution<int>(0, 1)(random);
  return TransferFunction(nodes, random() % 2 == 0 ? Interpolation::linear : Interpolation::monotone_cubic);
}

/// Of some of the data, as bits; the first is the lowest.
TEST(StrengthTable, tells_at_which_data_it_is_not_zero) {
  std::mt19937 random(6);
  std::uniform_real_distribution<double> anywhere(-1100, 800);
  for (int trial = 0; trial < 300; ++trial) {
    const TransferFunction function = zero_in_places(random);
    std::vector<double> data(std::uniform_int_distribution<std::size_t>(1, 64)(random));
    std::uint64_t asked = 0, expected = 0;
    for (std::size_t n = 0; n < data.size(); ++n) {
      data[n] = anywhere(random);
      if (random() % 3 == 0) continue;
      asked |= std::uint64_t{1} << n;
      if (function(data[n]) != 0) expected |= std::uint64_t{1} << n;
    }
    EXPECT_EQ(StrengthTable(function).not_zero(data, asked), expected) << trial;
  }
}

TEST(StrengthTable, multiplies_each_product_and_tells_if_none_is_left) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> anywhere(-1100, 800), factor(0, 2);
  int none_left = 0;
  for (int trial = 0; trial < 600; ++trial) {
    const TransferFunction function = zero_in_places(random);
    std::vector<double> data(std::uniform_int_distribution<std::size_t>(1, 12)(random)), products, expected;
    bool any = false;
    for (double& datum : data) {
      datum = trial % 2 == 0 ? anywhere(random) : function.nodes().back().at + 1;  // all of them may be beyond
      products.push_back(random() % 3 == 0 ? 0 : factor(random));
      expected.push_back(products.back() * function(datum));
      any = any || expected.back() != 0;
    }
    const bool is_left = StrengthTable(function).multiply(data, products);
    EXPECT_TRUE(is_left || !any) << trial;
    none_left += is_left ? 0 : 1;
    for (std::size_t n = 0; is_left && n < data.size(); ++n) EXPECT_NEAR(products[n], expected[n], 1e-11) << trial;
  }
  EXPECT_GT(none_left, 50);
}

TEST(Strength, is_not_zero_where_no_factor_of_a_datum_is) {
  std::mt19937 random(8);
  std::uniform_real_distribution<double> anywhere(-1100, 800);
  for (int trial = 0; trial < 200; ++trial) {
    const TransferFunction newtons = zero_in_places(random), gate = zero_in_places(random),
                           other = zero_in_places(random);
    const Strength strength(Datum::value, newtons,
                            {{Datum::gradient_magnitude, other}, {Datum::value, gate}, {Datum::value, gate}});
    std::vector<double> data;
    std::uint64_t asked = 0, expected = 0;
    for (std::size_t n = 0; n < 64; ++n) {
      data.push_back(anywhere(random));
      if (random() % 3 == 0) continue;
      asked |= std::uint64_t{1} << n;
      if (newtons(data[n]) != 0 && gate(data[n]) != 0) expected |= std::uint64_t{1} << n;
    }
    EXPECT_EQ(strength.not_zero(Datum::value, data, asked), expected) << trial;
    EXPECT_EQ(strength.not_zero(Datum::low, data, asked), asked) << "it has no factor of it";
    EXPECT_EQ(Strength{}.not_zero(Datum::value, data, asked), 0U);
  }
}

TEST(Strength, is_the_product_of_its_factors_and_reads_only_what_varies) {
  const Gate gate{Datum::value, TransferFunction({{0, 0}, {100, 1}})};
  const Gate open{Datum::high, TransferFunction(1.0)};
  const Strength strength(Datum::gradient_magnitude, TransferFunction({{0, 0}, {10, 2}}), {gate, open});
  EXPECT_TRUE(strength.reads() == (io::FieldSet::gradient | io::FieldSet::value));
  EXPECT_DOUBLE_EQ(strength({.inside = true, .value = 50, .gradient = {3, 0, 4}}), 0.5);
  EXPECT_EQ(strength({.inside = true, .value = 0, .gradient = {3, 0, 4}}), 0.0);
  EXPECT_EQ(Strength{}({.inside = true, .value = 50}), 0.0);
}

}  // namespace
}  // namespace palpate::modes
