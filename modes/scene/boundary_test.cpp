// What a pair of tissues says of a boundary: where each tissue is, and which of the two is the lower. And at which
// values a boundary begins to be felt.
#include "modes/scene/boundary.h"

#include <gtest/gtest.h>

#include <random>
#include <utility>
#include <vector>

#include "modes/scene/met_values.h"
#include "solver/text/testing/not_finite.h"

namespace palpate::modes {
namespace {

TEST(Boundary, a_tissue_is_whole_within_its_limits_half_at_them_and_nothing_beyond_their_softness) {
  for (const double low : {100.0, -infinity}) {
    for (const double high : {200.0, infinity}) {
      const TransferFunction gate = gate_of({.name = "t", .low = low, .high = high, .softness = 20});
      const bool begins = low == 100, ends = high == 200;
      for (const double inside : {110.0, 150.0, 190.0}) EXPECT_EQ(gate(inside), 1) << low << ' ' << high;
      for (const double below : {-1e9, 0.0, 90.0}) EXPECT_EQ(gate(below), begins ? 0 : 1) << low << ' ' << high;
      for (const double above : {210.0, 300.0, 1e9}) EXPECT_EQ(gate(above), ends ? 0 : 1) << low << ' ' << high;
      EXPECT_DOUBLE_EQ(gate(95), begins ? 0.25 : 1) << low << ' ' << high;
      EXPECT_DOUBLE_EQ(gate(100), begins ? 0.5 : 1) << low << ' ' << high;
      EXPECT_DOUBLE_EQ(gate(200), ends ? 0.5 : 1) << low << ' ' << high;
      EXPECT_DOUBLE_EQ(gate(205), ends ? 0.25 : 1) << low << ' ' << high;
    }
  }
  // As soft as it is wide: whole at one value only.
  const TransferFunction narrow = gate_of({.name = "t", .low = 100, .high = 120, .softness = 20});
  for (const auto& [value, part] : {std::pair{90.0, 0.0}, {100.0, 0.5}, {110.0, 1.0}, {120.0, 0.5}, {130.0, 0.0}}) {
    EXPECT_DOUBLE_EQ(narrow(value), part) << value;
  }
}

TEST(Boundary, lies_between_the_lower_tissue_and_the_higher_whichever_comes_first) {
  // An open tissue is as low or high as where it ends; the first reaches beyond the middle of the second.
  const std::vector<Tissue> ascending{{.name = "a", .low = -infinity, .high = 0, .softness = 100},
                                      {.name = "b", .low = -60, .high = 40, .softness = 10},
                                      {.name = "c", .low = 40, .high = 300, .softness = 10},
                                      {.name = "d", .low = 150, .high = infinity, .softness = 50}};
  for (std::size_t low = 0; low < ascending.size(); ++low) {
    for (std::size_t high = low + 1; high < ascending.size(); ++high) {
      for (const bool upwards : {true, false}) {
        const Boundary boundary = boundary_between(ascending[upwards ? low : high], ascending[upwards ? high : low]);
        EXPECT_EQ(boundary.side, upwards ? Side::entering : Side::leaving) << low << ' ' << high;
        ASSERT_EQ(boundary.gates.size(), 2U);
        EXPECT_EQ(boundary.gates[0].of, Datum::low);
        EXPECT_EQ(boundary.gates[1].of, Datum::high);
        for (const double value : {-200.0, -55.0, 20.0, 160.0, 400.0}) {
          EXPECT_EQ(boundary.gates[0].factor(value), gate_of(ascending[low])(value)) << low << ' ' << high;
          EXPECT_EQ(boundary.gates[1].factor(value), gate_of(ascending[high])(value)) << low << ' ' << high;
        }
      }
    }
  }
}

/// Windows of values one above the other, each with soft ends: entered at the middle of its lower end, left at the
/// middle of its upper one, and both from both sides. Whether one gate says it or a product of two.
TEST(MetValues, are_the_middles_of_the_ends_that_the_side_resists) {
  std::mt19937 random(8);
  const auto any = [&random](double least, double most) { return std::uniform_real_distribution(least, most)(random); };
  const Gate elsewhere{Datum::gradient_magnitude, TransferFunction({{0, 0}, {1, 1}})};
  for (int n = 0; n < 100; ++n) {
    const double most = any(0.1, 3);
    std::vector<Node> nodes, ascent, descent;
    std::vector<double> entered, left, both;
    double at = any(-1000, 0);
    const int windows = 1 + n % 3;
    for (int window = 0; window < windows; ++window) {
      const double soft = any(1, 50), width = any(1, 100), soft_end = any(1, 50);
      nodes.insert(nodes.end(), {{at, 0}, {at + soft, most}, {at + soft + width, most}});
      nodes.push_back({at + soft + width + soft_end, 0});
      ascent = {{at, 0}, {at + soft, 1}};
      descent = {{at + soft + width, most}, {at + soft + width + soft_end, 0}};
      entered.push_back(at + 0.5 * soft);
      left.push_back(at + soft + width + 0.5 * soft_end);
      both.insert(both.end(), {entered.back(), left.back()});
      at = nodes.back().at + any(1, 100);
    }
    Mode mode;
    mode.gates = {elsewhere, {Datum::value, TransferFunction(nodes)}};
    std::vector<Mode> modes{mode};
    mode.gates = {{Datum::value, TransferFunction(descent)}, elsewhere, {Datum::value, TransferFunction(ascent)}};
    if (windows == 1) modes.push_back(mode);
    for (const Mode& one : modes) {
      for (const auto& [side, expected] :
           {std::pair{Side::entering, entered}, {Side::leaving, left}, {Side::both, both}}) {
        const std::vector<double> met = met_values(one, side);
        ASSERT_EQ(met.size(), expected.size()) << n;
        for (std::size_t m = 0; m < met.size(); ++m) EXPECT_NEAR(met[m], expected[m], 1e-8) << n;
      }
    }
  }
  // Without a gate over value, or with one that is closed, there are none.
  Mode none;
  for (const Side side : {Side::entering, Side::leaving, Side::both}) {
    none.gates = {elsewhere};
    EXPECT_TRUE(met_values(none, side).empty());
    none.gates.push_back({Datum::value, TransferFunction({{0, 0}, {1, 0}})});
    EXPECT_TRUE(met_values(none, side).empty());
  }
}

}  // namespace
}  // namespace palpate::modes
