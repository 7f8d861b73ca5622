#pragma once

/// Inputs that the program refuses, and what it says of them.

#include <string>
#include <vector>

namespace palpate::plugin::testing {

struct Provoked {
  std::string wanted;  ///< the row of MESSAGES.md that it is for
  std::string said;
};

std::vector<Provoked> provoke_scenes();
std::vector<Provoked> provoke_balances();
std::vector<Provoked> provoke_files();
std::vector<Provoked> provoke_programs();
std::vector<Provoked> provoke_styluses();

/// All of them.
std::vector<Provoked> provoke_everything();

}  // namespace palpate::plugin::testing
