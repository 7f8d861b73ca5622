// Points as typed text: three finite numbers, and nothing else.
#include "plugin/app/vector_text.h"

#include <gtest/gtest.h>

#include "plugin/app/errors.h"

namespace palpate::plugin {
namespace {

TEST(VectorText, TakesThreeNumbersWithEitherSign) {
  EXPECT_EQ(parse_vector("-12.5,+40,8.8e1", "--at"), glm::dvec3(-12.5, 40, 88));
}

TEST(VectorText, RefusesWhatIsNoPoint) {
  for (const char* text :
       {"", "1,2", "1,2,3,4", "1,2,x", "1, 2,3", "nan,0,0", "0,inf,0", "0,0,-inf", "1,2,1e999", "+"}) {
    EXPECT_THROW(parse_vector(text, "--at"), WrongUsage) << text;
  }
}

}  // namespace
}  // namespace palpate::plugin
