#pragma once

/// Inputs that the program refuses, and what it says of them.

#include <string>
#include <vector>

namespace palpate::plugin::testing {

struct Provoked {
  std::string wanted;  ///< the row of messages.md that it is for
  std::string said;
};

std::vector<Provoked> provoke_scenes();
std::vector<Provoked> provoke_balances();
std::vector<Provoked> provoke_files();
std::vector<Provoked> provoke_headers();
std::vector<Provoked> provoke_pixels();
std::vector<Provoked> provoke_programs();
std::vector<Provoked> provoke_recordings();
/// Whether this build or machine keeps a message from being provoked that others provoke.
bool cannot_be_had_here(const std::string& message);

/// All of them that can be had here.
std::vector<Provoked> provoke_everything();

}  // namespace palpate::plugin::testing
