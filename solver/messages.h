#pragma once

/// The messages about balances.

#include "solver/text/message.h"

namespace palpate::solver::messages {

inline constexpr MessageRow balances[] = {
    {"a number that no balance can have",
     "correct that number",
     {{"is-negative", "{} is negative ({})"},
      {"not-positive", "{} is not positive ({})"},
      {"no-length", "{} has no length ({})"},
      {"not-finite", "{} is not finite ({})"},
      {"out-of-range", "{} is out of range ({}): at most {}{}"}}},
    {"no answer can be certified",
     "smaller numbers; fewer infinite strengths",
     {{"no-point-meets-it",
       "has infinite strength, but no point meets it together with the other hard constraints: it stays {} m away "
       "(tolerance: {} of the largest distance between probe and constraints)"}}},
};

}  // namespace palpate::solver::messages

namespace palpate::solver {

/// The message of this id, with these values in place of its {}.
template <typename... Values>
Text say(std::type_identity_t<ChosenMessage<sizeof...(Values), messages::balances>> message, const Values&... values) {
  return message.filled(values...);
}

}  // namespace palpate::solver
