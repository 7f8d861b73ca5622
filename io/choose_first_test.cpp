// The order of two series: each rule decides, from its limit on, against all rules after it.
#include "io/choose_first.h"

#include <gtest/gtest.h>

#include <array>
#include <functional>
#include <string>

namespace palpate::io {
namespace {

/// 30 slices of soft CT, 1 mm apart and as thick.
Series plain() {
  Series series;
  series.usable = true;
  series.modality = "CT";
  series.geometry.dimensions = {4, 4, 30};
  series.geometry.step = {0, 0, 1};
  series.details.thickness_mm = 1;
  series.details.kernel = "B30f";
  return series;
}

using Change = std::function<void(Series&)>;

Series with(const Change& change) {
  Series series = plain();
  change(series);
  return series;
}

/// Whether the better one is chosen, wherever it stands.
bool goes_before(const Series& better, const Series& worse) {
  const auto first = choose_first(std::array{better, worse}), second = choose_first(std::array{worse, better});
  return first && second && first->index == 0 && second->index == 1;
}

TEST(ChooseFirst, EachRuleGoesBeforeThoseBehindIt) {
  // From the weightiest to the lightest: what a series has that goes behind.
  const std::array<Change, 8> rules{[](Series& s) { s.modality = "PT"; },
                                    [](Series& s) { s.geometry.dimensions.z = 9; },
                                    [](Series& s) { s.details.is_projection = true; },
                                    [](Series& s) { s.details.thickness_mm = 2; },
                                    [](Series& s) { s.details.kernel = "B70f"; },
                                    [](Series& s) { s.details.is_derived = true; },
                                    [](Series& s) { s.details.is_lossy = true; },
                                    [](Series& s) { s.geometry.dimensions.z = 29; }};
  for (std::size_t rule = 0; rule < rules.size(); ++rule) {
    const Series worse = with(rules[rule]);
    EXPECT_TRUE(goes_before(plain(), worse)) << rule;
    const Series all_lighter = with([&](Series& s) {
      for (std::size_t n = rules.size(); n-- > rule + 1;) rules[n](s);
    });
    EXPECT_TRUE(goes_before(all_lighter, worse)) << rule;
  }
  EXPECT_TRUE(goes_before(with([](Series& s) { s.modality = "MR"; }), with(rules[0])));
  Series useless = plain();
  useless.usable = false;
  EXPECT_FALSE(choose_first(std::array{useless}));
  EXPECT_TRUE(goes_before(with(rules[0]), useless));
}

// Up to ten slices there are few; between these thicknesses a hand feels a difference, and within them none.
TEST(ChooseFirst, ThinSlicesAreThoseOfAStepLess) {
  const auto few = [](int slices) { return with([=](Series& s) { s.geometry.dimensions.z = slices; }); };
  const Series derived = with([](Series& s) { s.details.is_derived = true; });
  EXPECT_TRUE(goes_before(few(10), derived));
  EXPECT_TRUE(goes_before(derived, few(9)));
  for (const double step : {1.3, 2.1, 3.2, 5.2}) {
    for (const bool by_thickness : {false, true}) {
      const auto series_of = [&](double mm, int slices) {
        return with([=](Series& s) {
          s.details.thickness_mm = by_thickness ? mm : 0.5;
          s.geometry.step = {0, 0, by_thickness ? 0.5 : mm};
          s.geometry.dimensions.z = slices;
        });
      };
      EXPECT_TRUE(goes_before(series_of(step, 20), series_of(step + 0.01, 40))) << step;
      EXPECT_TRUE(goes_before(series_of(step - 0.01, 40), series_of(step - 0.2, 20))) << step;
      EXPECT_TRUE(goes_before(series_of(step + 0.2, 40), series_of(step + 0.01, 20))) << step;
    }
  }
}

TEST(ChooseFirst, SaysWhy) {
  const auto why = [](const Series& series) { return choose_first(std::array{series})->why; };
  EXPECT_EQ(why(plain()), "slices every 1.00 mm, soft kernel B30f, 30 slices");
  EXPECT_EQ(why(with([](Series& s) {
              s.details.kernel.clear();
              s.geometry.step = {0, 0, 2.746};
            })),
            "slices every 2.75 mm, 30 slices");
  EXPECT_EQ(why(with([](Series& s) { s.details.kernel = "LUNG"; })),
            "slices every 1.00 mm, sharp kernel LUNG, 30 slices");
}

TEST(ChooseFirst, KernelsAreSharpFromTheMakersNumbersOn) {
  for (int number = 0; number < 100; ++number) {
    const std::string digits = {static_cast<char>('0' + number / 10), static_cast<char>('0' + number % 10)};
    EXPECT_EQ(is_sharp("B" + digits), number >= 60) << number;
    EXPECT_EQ(is_sharp("Br" + digits + "d"), number >= 60) << number;
    EXPECT_FALSE(is_sharp("ABC" + digits)) << number;
    const int tens = number / 10;
    EXPECT_EQ(is_sharp("FC" + digits), tens == 3 || tens == 5 || tens >= 8) << number;
  }
}

}  // namespace
}  // namespace palpate::io
