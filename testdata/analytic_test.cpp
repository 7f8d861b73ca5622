#include "testdata/analytic.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

namespace palpate::testdata {
namespace {

constexpr io::FieldSet both = io::FieldSet::value | io::FieldSet::gradient;

TEST(Analytic, GradientIsTheDerivativeOfTheValue) {
  const Layer layers[] = {{-3, 40}, {2, 1000}};
  const Phantom phantoms[] = {make_slab({0, 1, 0}, layers), make_sphere(10), make_shell(6, 9),
                              make_tube(4, {0.6, 0.8, 0}), make_wedge(60)};
  constexpr double h = 1e-5;
  for (const Phantom& phantom : phantoms) {
    const AnalyticSource source(phantom, 1.5);
    for (const Vec3& p : {Vec3(1, 2, 3), Vec3(-5, 4, 0.2), Vec3(0.3, -9, 3), Vec3(6, 0.1, -0.7)}) {
      const io::Sample s = source.sample(p, both);
      for (int axis = 0; axis < 3; ++axis) {
        Vec3 e(0);
        e[axis] = h;
        const double slope = (source.sample(p + e, both).value - source.sample(p - e, both).value) / (2 * h);
        EXPECT_NEAR(s.gradient[axis], slope, 1e-5);
      }
    }
  }
}

TEST(Analytic, EdgeOfASlabIsAGaussianOne) {
  const Layer layers[] = {{0, 100}};
  const AnalyticSource source(make_slab({0, 0, 1}, layers, 0), 2);
  EXPECT_DOUBLE_EQ(source.sample({5, 5, 0}, both).value, 50);
  EXPECT_NEAR(source.sample({5, 5, 2}, both).value, 84.134474606854293, 1e-9);  // Phi(1)
  EXPECT_NEAR(source.sample({5, 5, 0}, both).gradient.z, 100 / (2 * std::sqrt(2 * std::acos(-1.0))), 1e-12);
}

TEST(Analytic, NothingIsFeltBeyondItsBounds) {
  const AnalyticSource source(make_sphere(10), 1, Vec3(-5), Vec3(5));
  EXPECT_TRUE(source.sample({5, 5, -5}, both).inside);
  const io::Sample out = source.sample({5.001, 0, 0}, both);
  EXPECT_FALSE(out.inside);
  EXPECT_EQ(out.value, 0);
  EXPECT_EQ(out.gradient, Vec3(0));
}

TEST(Analytic, GivesOnlyWhatIsWanted) {
  const AnalyticSource source(make_sphere(10));
  EXPECT_EQ(source.sample({0, 0, 10}, io::FieldSet::value).gradient, Vec3(0));
  EXPECT_EQ(source.sample({0, 0, 10}, io::FieldSet::gradient).value, 0);
  EXPECT_THROW(AnalyticSource(make_sphere(10), 0), std::invalid_argument);
}

}  // namespace
}  // namespace palpate::testdata
