#include <gtest/gtest.h>
#include <unistd.h>

namespace {

// Run by the CTest entry `test_limit`, which expects its end.
TEST(TestLimit, DISABLED_EndsOneThatHangs) {
  for (;;) pause();
}

}  // namespace
