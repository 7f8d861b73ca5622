// Filters of values of any size, and of NaN and infinity.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <set>
#include <vector>

#include "io/fields/filtered.h"
#include "io/fields/testing/odd_scan.h"
#include "testdata/scan.h"

namespace palpate::io {
namespace {

/// In other values the same is filtered, as far as floats tell values apart.
TEST(Filtered, FollowsAChangeOfTheValues) {
  const auto raw = odd_scan();
  for (const Filter& filter : filters) {
    const auto before = filtered(raw, filter);
    for (const double factor : {1e-12, 1e-6, 1.0 / 3000, 7.3, 1e3}) {
      for (const double offset_of_ranges : {0.0, 1.0, -20.0}) {
        Filter scaled = filter;
        scaled.sigma_value *= factor;
        const double offset = factor * 3000 * offset_of_ranges;
        Volume changed = *raw;
        changed.slope *= factor;
        changed.intercept = factor * changed.intercept + offset;
        const auto after = filtered(std::make_shared<const Volume>(changed), scaled);
        const double near = factor * 3000 * (1e-3 + 1e-5 * std::abs(offset_of_ranges));
        SCOPED_TRACE(::testing::Message() << in_words(filter) << ": " << factor << " x + " << offset);
        for (int n = 0; n < 41 * 37 * 38; n += 17) {
          const int i = n % 41, j = n / 41 % 37, k = n / (41 * 37);
          ASSERT_EQ(after->is_padding(i, j, k), raw->is_padding(i, j, k));
          ASSERT_NEAR(at(*after, i, j, k), factor * at(*before, i, j, k) + offset, near) << i << ' ' << j << ' ' << k;
        }
      }
    }
  }
}

/// What is no number is left out, as padding is: it spoils no neighbor, in its slice or in another one.
TEST(Filtered, WhatIsNoNumberStaysWhereItIsAndSpoilsNothing) {
  constexpr float inf = std::numeric_limits<float>::infinity(), padding = -2000;
  for (const float odd : {inf, -inf, std::numeric_limits<float>::quiet_NaN(), padding}) {
    Volume holed = *painted(testdata::make_geometry({.size = {20, 20, 5}}), [](const Vec3&) { return 100; });
    auto& voxels = std::get<std::vector<float>>(holed.voxels);
    std::set<std::size_t> holes{0, 7, 806, 807, 1200, 1999};
    for (std::size_t n = 400; n < 800; ++n) holes.insert(n);  // a whole slice
    for (const std::size_t n : holes) voxels[n] = odd;
    if (odd == padding) holed.padding = {padding, padding};
    const auto raw = std::make_shared<const Volume>(holed);
    for (const Filter& filter : filters) {
      const auto smooth = filtered(raw, filter);
      for (std::size_t n = 0; n < voxels.size(); ++n) {
        const float now = std::get<std::vector<float>>(smooth->voxels)[n];
        if (!holes.contains(n)) {
          ASSERT_NEAR(now, 100, 1e-3) << in_words(filter) << ' ' << n;
        } else {
          ASSERT_TRUE(now == odd || (std::isnan(now) && std::isnan(odd))) << in_words(filter) << ' ' << n;
        }
      }
    }
  }
}

/// Where floats cannot hold the values any more there is little to filter, and no fault.
TEST(Filtered, SlopesAndOffsetsOfAnySizeAreNoFault) {
  for (const double factor : {1e-300, 1e12, 1e36, 1e300}) {
    for (const double offset : {0.0, -1e12, 1e38, 1e300}) {
      for (const bool has_padding : {false, true}) {
        Volume changed = *odd_scan();
        changed.slope *= factor;
        changed.intercept = factor * changed.intercept + offset;
        if (!has_padding) changed.padding.reset();
        const auto raw = std::make_shared<const Volume>(changed);
        for (const Filter& filter : filters) {
          SCOPED_TRACE(::testing::Message() << in_words(filter) << ": " << factor << " x + " << offset);
          std::shared_ptr<const Volume> smooth;
          EXPECT_NO_THROW(smooth = filtered(raw, filter));
          // What was no number to begin with is left as it was.
          for (int n = 0; n < 41 * 37 * 38; n += 101) {
            const int i = n % 41, j = n / 41 % 37, k = n / (41 * 37);
            const auto before = static_cast<float>(at(*raw, i, j, k));
            if (!std::isfinite(before)) {
              ASSERT_EQ(at(*smooth, i, j, k), before);
            }
          }
        }
      }
    }
  }
}

}  // namespace
}  // namespace palpate::io
