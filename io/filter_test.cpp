// The names of filters, their valid settings, and which settings each type reads.
#include "io/filter.h"

#include <gtest/gtest.h>

#include <opencv2/core.hpp>
#include <set>
#include <stdexcept>
#include <string_view>

namespace palpate::io {
namespace {

Filter filter_of(const FilterType* type, double sigma_mm = 1, double sigma_value = 20, int width = 3) {
  Filter filter;
  filter.type = type;
  filter.sigma_mm = sigma_mm;
  filter.sigma_value = sigma_value;
  filter.width = width;
  return filter;
}

TEST(FilterInWords, SaysWhatItReads) {
  EXPECT_EQ(in_words(filter_of(nullptr)), "no filter");
  EXPECT_EQ(in_words(filter_of(find_filter_type("gaussian"), 1.25)), "Gaussian filter of 1.25 mm");
  EXPECT_EQ(in_words(filter_of(find_filter_type("median"), 1, 20, 5)), "median filter of 5 x 5 voxels");
  EXPECT_EQ(in_words(filter_of(find_filter_type("bilateral"), 1.5, 40)), "bilateral filter of 1.5 mm and 40");
  EXPECT_EQ(in_words(filter_of(find_filter_type("non_local_means"), 1.5, 40)), "non-local means filter of 40");
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
  const FilterType* const gaussian = find_filter_type("gaussian");
  const FilterType* const median = find_filter_type("median");
  const FilterType* const bilateral = find_filter_type("bilateral");
  const FilterType* const non_local_means = find_filter_type("non_local_means");
  const FilterType* const none = nullptr;
  for (const FilterType* const type : {none, gaussian, median, bilateral, non_local_means}) {
    const bool mm = type == gaussian || type == bilateral;
    const bool value = type == bilateral || type == non_local_means;
    EXPECT_TRUE(may_be(filter_of(type)));
    for (const double good : {0.1, 10.0}) EXPECT_TRUE(may_be(filter_of(type, good)));
    for (const double bad : {0.099, 10.01, 0.0, -1.0}) EXPECT_EQ(may_be(filter_of(type, bad)), !mm) << bad;
    for (const double good : {1e-6, 1e5}) EXPECT_TRUE(may_be(filter_of(type, 1, good)));
    for (const double bad : {0.0, -1.0, 1.01e5}) EXPECT_EQ(may_be(filter_of(type, 1, bad)), !value) << bad;
    EXPECT_TRUE(may_be(filter_of(type, 1, 20, 5)));
    for (const int bad : {0, 1, 2, 4, 6, 7}) {
      EXPECT_EQ(may_be(filter_of(type, 1, 20, bad)), type != median) << bad;
    }
    // And it is another filter where one of them differs.
    EXPECT_TRUE(filter_of(type) == filter_of(type));
    EXPECT_EQ(filter_of(type) == filter_of(type, 2), !mm);
    EXPECT_EQ(filter_of(type) == filter_of(type, 1, 30), !value);
    EXPECT_EQ(filter_of(type) == filter_of(type, 1, 20, 5), type != median);
    EXPECT_FALSE(filter_of(type) == filter_of(type == gaussian ? bilateral : gaussian));
  }
}

TEST(FilterTypes, EachHasANameATitleAndASummaryOfItsOwn) {
  std::set<std::string_view> names{"none"}, titles, summaries;
  for (const FilterType* const type : filter_types()) {
    EXPECT_TRUE(names.insert(type->name).second) << type->name;
    EXPECT_TRUE(titles.insert(type->title).second) << type->name;
    EXPECT_TRUE(summaries.insert(type->summary).second) << type->name;
    EXPECT_EQ(find_filter_type(type->name), type);
    EXPECT_FALSE(in_words(filter_of(type)).empty());
    EXPECT_TRUE(type->reads_sigma_mm || !type->reaches_across) << "what reaches across is a Gaussian of sigma_mm";
  }
  EXPECT_EQ(find_filter_type("none"), nullptr);
  EXPECT_EQ(find_filter_type(""), nullptr);
}

/// A slice of one value is what every filter leaves as it is, and its blur is a variance.
TEST(FilterTypes, EachLeavesASliceOfOneValueAsItIs) {
  Geometry geometry;
  geometry.spacing_i = 0.7;
  geometry.spacing_j = 1.3;
  for (const FilterType* const type : filter_types()) {
    const Filter filter = filter_of(type, 1.2, 20, 5);
    const cv::Mat slice(40, 30, CV_32F, cv::Scalar(73.25));
    const cv::Mat result = type->in_slice(slice, geometry, filter);
    ASSERT_EQ(result.size(), slice.size()) << type->name;
    ASSERT_EQ(result.type(), CV_32F) << type->name;
    double low = 0, high = 0;
    cv::minMaxLoc(result, &low, &high);
    EXPECT_NEAR(low, 73.25, 1e-4) << type->name;
    EXPECT_NEAR(high, 73.25, 1e-4) << type->name;
    EXPECT_TRUE(type->blur == nullptr || type->blur(geometry, filter, geometry.direction_i) > 0) << type->name;
  }
}

}  // namespace
}  // namespace palpate::io
