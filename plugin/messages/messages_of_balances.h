#pragma once

/// Messages of `palpate solve`.

#include "solver/text/message.h"

namespace palpate::plugin::messages {

inline constexpr MessageRow balances[] = {
    {"the line is no balance",
     "correct the line",
     {{"not-json", "not JSON: {}"},
      {"nested-more-than-deep", "nested more than {} deep"},
      {"given-twice", "\"{}\" is given twice"},
      {"longer-than-bytes", "longer than {} bytes"},
      {"line-is-empty", "the line is empty"},
      {"not-a-json-object-but-of-type", "not a JSON object but of type {}"},
      {"not-an-object", "not an object"}}},
    {"a member is not what it should be",
     "correct that member",
     {{"is-missing", "{} is missing"},
      {"not-a-number", "{} is not a number"},
      {"not-an-array-of-three-numbers", "{} is not an array of three numbers"},
      {"strength-is-neither-a-number-nor-inf", "strength is neither a number nor \"inf\""},
      {"type-is-not-a-string", "type is not a string"},
      {"type-is-unknown", "type \"{}\" is unknown; there are force, plane, line and point"},
      {"id-is-neither-a-string-nor", "id is neither a string nor a number"},
      {"primitives-is-not-an-array", "primitives is not an array"}}},
    {"no answer can be certified",
     "smaller numbers; fewer infinite strengths",
     {{"no-answer-with-a-finite-error-bound", "no answer with a finite error bound was found"},
      {"hard-constraints-disagree",
       "primitive {}: has infinite strength, but the best answer found stays {} m away: the hard constraints seem to "
       "have no "
       "common point"}}},
    {"that solver is for other primitives",
     "`--solver chain` fits all",
     {{"solver-does-not-fit-this-configuration", "the {} solver does not fit this configuration"}}},
    {"as each answer says",
     "correct those lines",
     {{"lines-not-solved", "{} of {} line{} could not be solved: see \"error\" in the answers"}}},
    {"the other end of the pipe is gone",
     "run it again",
     {{"standard-output-cannot-be-written", "standard output cannot be written"},
      {"standard-input-cannot-be-read", "standard input cannot be read"}}},
    {"no answer can be certified",
     "smaller numbers; fewer infinite strengths",
     {{"answer-is-not-finite", "the answer is not finite: the numbers given are too large"}}},
};

}  // namespace palpate::plugin::messages
