#pragma once

/// Inputs that the programs refuse, with the resulting messages.

#include <string>
#include <vector>

#include "solver/text/testing/shown.h"

namespace palpate::plugin::testing {

using palpate::testing::Provoked;

std::vector<Provoked> provoke_balances();
std::vector<Provoked> provoke_openigtlink();
std::vector<Provoked> provoke_programs();
std::vector<Provoked> provoke_recordings();

}  // namespace palpate::plugin::testing
