/// The hills of a curve: what is said of them, held against curves of any kind, and against a count by another way.

#include "modes/scene/hills.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <vector>

namespace palpate::modes::internal {
namespace {

/// Without two equal neighbors, so that a valley is one bin.
std::vector<float> any_curve(std::mt19937& random, std::size_t size) {
  std::vector<float> curve(size);
  for (std::size_t i = 0; i < size; ++i) {
    do {
      curve[i] = static_cast<float>(1 + random() % 1000);
    } while (i > 0 && curve[i] == curve[i - 1]);
  }
  return curve;
}

std::vector<std::size_t> tops_of(const std::vector<Hill>& hills) {
  std::vector<std::size_t> tops;
  for (const Hill& hill : hills) tops.push_back(hill.top);
  return tops;
}

/// One after another they cover the curve, each with its highest bin as its top.
TEST(Hills, CoverTheCurve) {
  std::mt19937 random(1);
  for (int n = 0; n < 500; ++n) {
    const std::vector<float> curve = any_curve(random, 1 + random() % 60);
    const auto hills = hills_of(curve, 0.1 * (n % 10), 0.02 * (n % 7));
    ASSERT_FALSE(hills.empty());
    EXPECT_EQ(hills.front().first, 0U);
    EXPECT_EQ(hills.back().end, curve.size());
    for (std::size_t h = 0; h < hills.size(); ++h) {
      if (h > 0) {
        EXPECT_EQ(hills[h].first, hills[h - 1].end);
      }
      ASSERT_LT(hills[h].first, hills[h].end);
      const float highest = *std::max_element(curve.begin() + static_cast<std::ptrdiff_t>(hills[h].first),
                                              curve.begin() + static_cast<std::ptrdiff_t>(hills[h].end));
      EXPECT_EQ(curve[hills[h].top], highest);
      EXPECT_GE(hills[h].top, hills[h].first);
      EXPECT_LT(hills[h].top, hills[h].end);
    }
  }
}

/// Each of several stands out of the higher of its valleys by its share of its height, and holds its share of the sum.
TEST(Hills, StandOutAndHoldTheirShare) {
  std::mt19937 random(2);
  int several = 0;
  for (int n = 0; n < 500; ++n) {
    const std::vector<float> curve = any_curve(random, 2 + random() % 60);
    const double prominence = 0.1 * (n % 10), mass = 0.02 * (n % 7);
    const auto hills = hills_of(curve, prominence, mass);
    const double all = std::accumulate(curve.begin(), curve.end(), 0.0);
    if (hills.size() == 1) continue;
    ++several;
    for (std::size_t h = 0; h < hills.size(); ++h) {
      double sum = 0, left = 0, right = 0;
      for (std::size_t i = hills[h].first; i < hills[h].end; ++i) sum += curve[i];
      // The valleys: the least between this top and those beside it.
      const auto least = [&](std::size_t a, std::size_t b) {
        return *std::min_element(curve.begin() + static_cast<std::ptrdiff_t>(a),
                                 curve.begin() + static_cast<std::ptrdiff_t>(b));
      };
      if (h > 0) left = least(hills[h - 1].top, hills[h].top);
      if (h + 1 < hills.size()) right = least(hills[h].top, hills[h + 1].top);
      const double height = curve[hills[h].top];
      EXPECT_GE(height - std::max(left, right), prominence * height * (1 - 1e-12));
      EXPECT_GE(sum, mass * all * (1 - 1e-12));
    }
  }
  EXPECT_GT(several, 200);
}

/// Where nothing is asked of them, each local maximum is one.
TEST(Hills, WithoutConditionsAreAllMaxima) {
  std::mt19937 random(3);
  for (int n = 0; n < 200; ++n) {
    const std::vector<float> curve = any_curve(random, 1 + random() % 60);
    std::vector<std::size_t> maxima;
    for (std::size_t i = 0; i < curve.size(); ++i) {
      if ((i == 0 || curve[i] > curve[i - 1]) && (i + 1 == curve.size() || curve[i] > curve[i + 1]))
        maxima.push_back(i);
    }
    EXPECT_EQ(tops_of(hills_of(curve, 0, 0)), maxima);
  }
}

/// Turned round, or made larger, it has the same hills; its highest bin is always one of their tops.
TEST(Hills, AreTheSameFromEitherSideAndAtAnySize) {
  std::mt19937 random(4);
  for (int n = 0; n < 200; ++n) {
    std::vector<float> curve(2 + random() % 40);
    for (float& count : curve) count = static_cast<float>(random() % 1000003);
    const double prominence = 0.1 * (n % 10);
    auto tops = tops_of(hills_of(curve, prominence, 0));
    const auto highest = static_cast<std::size_t>(std::max_element(curve.begin(), curve.end()) - curve.begin());
    EXPECT_EQ(std::count(tops.begin(), tops.end(), highest), 1);
    std::vector<float> larger = curve;
    for (const float size : {0x1p3F, 0x1p-30F}) {
      std::transform(curve.begin(), curve.end(), larger.begin(), [size](float count) { return size * count; });
      EXPECT_EQ(tops_of(hills_of(larger, prominence, 0)), tops);
    }
    std::reverse(curve.begin(), curve.end());
    for (std::size_t& top : tops) top = curve.size() - 1 - top;
    std::reverse(tops.begin(), tops.end());
    EXPECT_EQ(tops_of(hills_of(curve, prominence, 0)), tops);
  }
}

/// The last that is merged is the one that stands out least: by a known answer for each limit.
TEST(Hills, KnownCurves) {
  EXPECT_TRUE(hills_of({}, 0.5, 0.1).empty());
  const std::vector<float> flat(7, 3.0F), nothing(5, 0.0F);
  EXPECT_EQ(hills_of(flat, 0.5, 0.1).size(), 1U);
  EXPECT_EQ(hills_of(nothing, 0.5, 0.1).size(), 1U);
  // A hill of 10 beside one of 100, with a valley of 5 between: it stands out by half of its height.
  const std::vector<float> pair{0, 100, 5, 10, 0};
  EXPECT_EQ(hills_of(pair, 0.5, 0).size(), 2U);
  EXPECT_EQ(hills_of(pair, 0.51, 0).size(), 1U);
  EXPECT_EQ(hills_of(pair, 0.51, 0)[0].top, 1U);
  // It holds 15 of 115, or 10 if the valley is the other's.
  EXPECT_EQ(hills_of(pair, 0.1, 9.0 / 115).size(), 2U);
  EXPECT_EQ(hills_of(pair, 0.1, 16.0 / 115).size(), 1U);
  // A flat valley is cut in its middle.
  const std::vector<float> valley{9, 1, 1, 1, 1, 1, 9};
  const auto two = hills_of(valley, 0.5, 0);
  ASSERT_EQ(two.size(), 2U);
  EXPECT_EQ(two[1].first, 3U);
  // Three hills, of which the middle one hangs together with the right one.
  const std::vector<float> three{80, 10, 50, 45, 90};
  EXPECT_EQ(tops_of(hills_of(three, 0.2, 0)), (std::vector<std::size_t>{0, 4}));
  EXPECT_EQ(tops_of(hills_of(three, 0.05, 0)), (std::vector<std::size_t>{0, 2, 4}));
  EXPECT_EQ(tops_of(hills_of(three, 0.9, 0)), (std::vector<std::size_t>{4}));
}

}  // namespace
}  // namespace palpate::modes::internal
