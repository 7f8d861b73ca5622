#include "io/fields/field_source.h"

#include <gtest/gtest.h>

#include <initializer_list>
#include <utility>

namespace palpate::io {
namespace {

Distances of(std::initializer_list<double> all_mm) {
  Distances distances;
  std::size_t n = 0;
  for (const double mm : all_mm) distances[n++] = {.mm = mm, .gradient = Vec3(mm, 0, 1)};
  return distances;
}

void expect_is(const Distances& found, std::initializer_list<double> all_mm) {
  std::size_t n = 0;
  for (const double mm : all_mm) {
    EXPECT_EQ(found[n].mm, mm) << n;
    EXPECT_EQ(found[n].gradient, Vec3(mm, 0, 1)) << n;
    ++n;
  }
  for (; n < most_structures; ++n) {
    EXPECT_EQ(found[n].mm, 0) << n;
    EXPECT_EQ(found[n].gradient, Vec3(0)) << n;
  }
}

TEST(Distances, AreZeroWhereThereIsNone) {
  expect_is({}, {});
  expect_is(of({3}), {3});
  expect_is(of({1, 2, 3, 4, 5, 6, 7, 8}), {1, 2, 3, 4, 5, 6, 7, 8});
}

TEST(Distances, BeforeOneThatIsWrittenAreZero) {
  Distances distances = of({5});
  distances[3].mm = 7;
  const Distances& found = distances;
  EXPECT_EQ(found[0].mm, 5);
  for (const std::size_t n : {1, 2}) {
    EXPECT_EQ(found[n].mm, 0);
    EXPECT_EQ(found[n].gradient, Vec3(0));
  }
  EXPECT_EQ(found[3].mm, 7);
  EXPECT_EQ(found[3].gradient, Vec3(0));
  EXPECT_EQ(found[4].mm, 0);
}

TEST(Distances, OfACopyAreThoseAndNoOthers) {
  const Distances two = of({1, 2});
  const Distances copy = two;
  expect_is(copy, {1, 2});
  Distances longer = of({9, 8, 7, 6});
  longer = two;
  expect_is(longer, {1, 2});
  longer[3] = {};
  expect_is(of({1, 2}), {1, 2});
  EXPECT_EQ(std::as_const(longer)[2].mm, 0) << "what was there before does not come back";
}

}  // namespace
}  // namespace palpate::io
