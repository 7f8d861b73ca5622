// A fetch or a sending that is canceled while an archive misbehaves ends soon, and leaves nothing.

#include <gtest/gtest.h>

#include <chrono>
#include <filesystem>

#include "io/archive/fetch.h"
#include "io/archive/send.h"
#include "io/archive/testing/made_series.h"
#include "io/archive/testing/odd_archive.h"
#include "io/errors.h"

namespace palpate::io {
namespace {

using std::chrono::milliseconds;
using testing::OddArchive;

struct Since {
  std::chrono::steady_clock::time_point begin = std::chrono::steady_clock::now();
  std::chrono::steady_clock::duration operator()() const { return std::chrono::steady_clock::now() - begin; }
};

/// It sends without end; it stalls in the midst of a message part; it has called back and says nothing.
TEST(Canceled, AFetchEndsSoon) {
  const struct {
    const char* behavior;
    bool uses_get;
  } all[] = {{"without-end", true}, {"drips", true}, {"drips-at-move", false}, {"falls-silent-at-move", false}};
  for (const auto& [behavior, uses_get] : all) {
    OddArchive odd(behavior);
    odd.archive().uses_get = uses_get;
    odd.archive().silence_s = 60;
    const Since since;
    EXPECT_THROW(fetch(odd.archive(), {"1.2.3"}, odd.folder(), {},
                       [&](const FetchProgress&) { return since() < milliseconds(1000); }),
                 Cancelled);
    EXPECT_LT(since(), milliseconds(10000)) << behavior;
    EXPECT_EQ(odd.entries(), 0U) << behavior;
  }
}

TEST(Canceled, ASendingEndsSoon) {
  const std::filesystem::path series = testing::made_series() / testing::ct;
  OddArchive silent("silent-at-store");
  silent.archive().silence_s = 60;
  const Since since;
  EXPECT_THROW(send(silent.archive(), {std::filesystem::directory_iterator(series)->path()},
                    [&](std::size_t) { return since() < milliseconds(300); }),
               Cancelled);
  EXPECT_LT(since(), milliseconds(30000));
}

}  // namespace
}  // namespace palpate::io
