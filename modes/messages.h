#pragma once

/// The messages about scenes.

#include "solver/text/message.h"

namespace palpate::modes::messages {

inline constexpr MessageRow scenes[] = {
    {"a mode names a structure that the scene does not",
     "add it to `structures`, or name another",
     {{"there-is-no-structure", "there is no structure \"{}\" in structures"}}},
    {"each is looked up in every sub-step",
     "",
     {{"too-many-structures", "structures: more than {} are read by modes or have a margin; switch some off"}}},
    {"a name that is neither a file nor a starting scene",
     "choose from the list",
     {{"no-such-scene-file-can-be-read", "{}: no such scene file can be read; the starting scenes are: {}"}}},
    {"a name that is no file, or one that may not be read",
     "name a file that can be read",
     {{"no-such-edits-can-be-read", "{}: no such file of edits can be read"}}},
    {"a word that is not known there",
     "choose from the list",
     {{"there-is-no-such-key-here", "there is no such key here; there are: {}"},
      {"there-is-no-mode", "there is no mode \"{}\"; there are: {}"},
      {"there-is-no-such-name", "there is no \"{}\"; there are: {}"},
      {"there-is-no-tissue-in-tissues", "there is no tissue \"{}\" in tissues"}}},
    {"another kind of value is wanted",
     "change that key",
     {{"not-a-number", "{} is not a number"},
      {"not-a-whole-number", "{} is not a whole number"},
      {"not-true-or-false", "{} is not true or false"},
      {"not-a-text-in-quotes", "{} is not a text in quotes"},
      {"not-a-list", "is not a list"},
      {"not-a-list-of", "is not a list of {}"},
      {"not-an-object-in-braces", "is not an object in braces"}}},
    {"a key that has to be there", "add it", {{"is-missing", "is missing"}, {"missing-strength", "is missing; {}"}}},
    {"lists in lists without an end", "check how the file was made", {{"nested-too-deep", "nested more than {} deep"}}},
    {"two things of one name",
     "take one away, or rename it",
     {{"given-twice", "is given twice"}, {"used-twice", "\"{}\" is used twice"}}},
    {"no such strength, size or place is possible",
     "change the number",
     {{"not-a-number-above-0", "{} is not a number above 0; it is in {}"},
      {"negative-value", "{} is negative; {}, 0 or more"},
      {"not-finite", "is not finite"}}},
    {"a color is six hexadecimal digits",
     "write it as the message shows",
     {{"not-a-color-such-as-0072b2", "\"{}\" is not a color such as \"#0072b2\""}}},
    {"the workspace's rotation is not a rotation",
     "leave it out, or let the panel set it",
     {{"axes-are-not-of-unit-length", "its axes are not of unit length and at right angles"},
      {"mirror-image", "is a mirror image: right would be left"}}},
    {"a tissue's range, or the pair of tissues of a boundary",
     "change those keys",
     {{"low-not-below-high", "has to be below high"},
      {"not-above-0-and-at-most", "{} is not above 0 and at most high - low"},
      {"boundary-lies-between-two-different-tissues", "a boundary lies between two different tissues"}}},
    {"both were given",
     "",
     {{"drawn-structure-has-no-segment", "has no meaning without a file: leave it out, or name the file"},
      {"side-follows-from-the-tissues", "the side follows from the tissues; leave out side, or from and to"}}},
    {"a direction of 0,0,0", "give one", {{"no-length", "has no length"}}},
    {"no solver is left", "switch one on", {{"all-are-switched-off", "all are switched off"}}},
    {"a tick has no time for more",
     "",
     {{"not-between-0-and-1000", "{} is not between 0 and 1000"},
      {"not-between-1-and-1000", "{} is not between 1 and 1000"},
      {"too-many", "{} are too many; at most {} are allowed"}}},
    {"one slice, or a stylus without reach",
     "give center_mm and scale instead",
     {{"workspace-fit-the-scan-or-the-device", "workspace.fit: the scan or the device has no extent"}}},
    {"not a transfer function",
     "change its nodes",
     {{"nodes-there-are-none", "nodes: there are none; at least one is needed"},
      {"not-a-usable-number", "{}: is not a usable number (finite, at most 1e30)"},
      {"nodes-do-not-ascend", "{}: has to lie beyond the node before (nodes ascend in their first number)"}}},
    {"a scene of a later version", "take a newer Palpate", {{"not-known", "{} is not known; this program reads {}"}}},
    {"a bracket or a quote is missing there", "correct that place", {{"not-json", "{}: {}"}}},
};

}  // namespace palpate::modes::messages

namespace palpate::modes {

/// The message of this id, with these values in place of its {}.
template <typename... Values>
Text say(std::type_identity_t<ChosenMessage<sizeof...(Values), messages::scenes>> message, const Values&... values) {
  return message.filled(values...);
}

}  // namespace palpate::modes
