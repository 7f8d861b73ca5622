// No form in which scanners send a scan is a slow path: each beside the plain form, as a ratio.
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "io/fields/gradient.h"
#include "modes/scene/suggest.h"
#include "solver/text/testing/sanitized.h"
#include "testdata/scan_shapes.h"

namespace palpate::modes {
namespace {

using Scan = std::shared_ptr<const io::Volume>;

void pass_over(const io::GradientKernel& kernel) {
  kernel.for_each_block([](const io::Block&, std::span<const glm::vec3>) {}, {}, 1);
}

/// What a form costs of the plain one, as `palpate-bench waits --shapes --slices 48` prints it.
struct Costs {
  const char* shape;
  double gradient, differences, suggest;
};
constexpr Costs measured[]{{"padding outside a circle", 1.4, 2.0, 1.2},
                           {"the same, not said to be padding", 1.0, 1.0, 1.0},
                           {"padding within", 1.7, 1.4, 1.3},
                           {"uneven slices", 1.4, 1.0, 1.2},
                           {"slices tilted by 20 degrees", 4.2, 1.0, 1.7},
                           {"floats", 1.4, 1.4, 1.3},
                           {"floats, NaN outside a circle", 1.7, 2.0, 1.3},
                           {"8 bits", 1.1, 1.0, 1.0},
                           {"MR of wide range and low contrast", 1.0, 1.0, 1.0}};

TEST(ScanShapes, CostLittleMoreThanThePlainOne) {
  if (is_sanitized) GTEST_SKIP() << "the checks of sanitizers take their own time";
  constexpr double room = 1.5;
  constexpr int rounds = 3;
  const Scan plain = testdata::plain_chest({512, 512, 32});
  ASSERT_EQ(std::size(measured), testdata::scan_shapes().size());
  for (std::size_t n = 0; n < std::size(measured); ++n) {
    const testdata::ScanShape& shape = testdata::scan_shapes()[n];
    ASSERT_EQ(shape.name, measured[n].shape);
    const Scan scan = shape.from(*plain);
    const auto ratio = [&](int times, const std::function<void(const Scan&)>& work) {
      return testdata::compare_costs(
                 times, [&] { work(plain); }, [&] { work(scan); })
          .ratio();
    };
    const auto gradient = [](const Scan& of) { pass_over({of, io::default_gradient_scale_mm(of->geometry)}); };
    const auto differences = [](const Scan& of) { pass_over({of, io::GradientKernel::CentralDifferences{}}); };
    EXPECT_LT(ratio(rounds, gradient), room * measured[n].gradient) << shape.name;
    EXPECT_LT(ratio(rounds, differences), room * measured[n].differences) << shape.name;
    EXPECT_LT(ratio(2, [](const Scan& of) { (void)suggest(of, {}, 1); }), room * measured[n].suggest) << shape.name;
  }
}

}  // namespace
}  // namespace palpate::modes
