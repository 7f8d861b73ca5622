// Each message of the module's table, as it is said.

#include "solver/messages.h"

#include <gtest/gtest.h>

#include <array>

#include "solver/balance.h"
#include "solver/text/testing/shown.h"

namespace palpate::solver {
namespace {

TEST(MessagesOfBalances, EachIsShown) {
  const auto said = [](Field field, Flaw flaw) { return describe({2, field, flaw, -1}); };
  const std::array provoked{
      testing::Provoked{"not-finite", said(Field::probe, Flaw::not_finite)},
      testing::Provoked{"is-negative", said(Field::strength, Flaw::negative)},
      testing::Provoked{"not-positive", said(Field::stiffness, Flaw::not_positive)},
      testing::Provoked{"no-length", said(Field::direction, Flaw::zero_direction)},
      testing::Provoked{"out-of-range", said(Field::stiffness, Flaw::out_of_range)},
      testing::Provoked{"no-point-meets-it", said(Field::strength, Flaw::incompatible)},
  };
  testing::expect_all_shown({messages::balances}, provoked, {}, PALPATE_SOURCES);
}

}  // namespace
}  // namespace palpate::solver
