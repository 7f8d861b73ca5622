// What a filter is called, which numbers it may have, and which of them it reads.
#include "io/filter.h"

#include <gtest/gtest.h>

#include <stdexcept>

namespace palpate::io {
namespace {

Filter filter_of(FilterType type, double sigma_mm = 1, double sigma_value = 20, int width = 3) {
  Filter filter;
  filter.type = type;
  filter.sigma_mm = sigma_mm;
  filter.sigma_value = sigma_value;
  filter.width = width;
  return filter;
}

TEST(FilterInWords, SaysWhatItReads) {
  EXPECT_EQ(in_words(filter_of(FilterType::none)), "no filter");
  EXPECT_EQ(in_words(filter_of(FilterType::gaussian, 1.25)), "Gaussian filter of 1.25 mm");
  EXPECT_EQ(in_words(filter_of(FilterType::median, 1, 20, 5)), "median filter of 5 x 5 voxels");
  EXPECT_EQ(in_words(filter_of(FilterType::bilateral, 1.5, 40)), "bilateral filter of 1.5 mm and 40");
  EXPECT_EQ(in_words(filter_of(FilterType::non_local_means, 1.5, 40)), "non-local means filter of 40");
}

bool may_be(const Filter& filter) {
  try {
    validate(filter);
  } catch (const std::invalid_argument&) {
    return false;
  }
  return true;
}

TEST(FilterLimits, HoldForTheNumbersThatItReads) {
  for (const FilterType type : {FilterType::none, FilterType::gaussian, FilterType::median, FilterType::bilateral,
                                FilterType::non_local_means}) {
    const bool mm = type == FilterType::gaussian || type == FilterType::bilateral;
    const bool value = type == FilterType::bilateral || type == FilterType::non_local_means;
    EXPECT_TRUE(may_be(filter_of(type)));
    for (const double good : {0.1, 10.0}) EXPECT_TRUE(may_be(filter_of(type, good)));
    for (const double bad : {0.099, 10.01, 0.0, -1.0}) EXPECT_EQ(may_be(filter_of(type, bad)), !mm) << bad;
    for (const double good : {1e-6, 1e5}) EXPECT_TRUE(may_be(filter_of(type, 1, good)));
    for (const double bad : {0.0, -1.0, 1.01e5}) EXPECT_EQ(may_be(filter_of(type, 1, bad)), !value) << bad;
    EXPECT_TRUE(may_be(filter_of(type, 1, 20, 5)));
    for (const int bad : {0, 1, 2, 4, 6, 7}) {
      EXPECT_EQ(may_be(filter_of(type, 1, 20, bad)), type != FilterType::median) << bad;
    }
    // And it is another filter where one of them differs.
    EXPECT_TRUE(filter_of(type) == filter_of(type));
    EXPECT_EQ(filter_of(type) == filter_of(type, 2), !mm);
    EXPECT_EQ(filter_of(type) == filter_of(type, 1, 30), !value);
    EXPECT_EQ(filter_of(type) == filter_of(type, 1, 20, 5), type != FilterType::median);
    EXPECT_FALSE(filter_of(type) ==
                 filter_of(type == FilterType::gaussian ? FilterType::bilateral : FilterType::gaussian));
  }
}

}  // namespace
}  // namespace palpate::io
