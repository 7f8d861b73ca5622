#pragma once

/// The marks of clients among those of the session.

#include <cstddef>
#include <vector>

#include "plugin/openigtlink/contents.h"

namespace palpate::plugin::igtl {

/// In a message, and in a session to which a client adds.
inline constexpr std::size_t most_marks = 1024;

/// A mark that is new or was moved.
struct ChangedMark {
  std::size_t at = 0;  ///< its place among the known ones; a new one comes after all others
  Point mark;          ///< with the name that it has or gets
};

/// The marks of a client's list that are new or were moved, in the order of their places. Names are compared as they
/// come back from a client: a long one is cut. A mark that is in the list with name and place stays. Then a mark of the
/// list moves a known one of its name that the list does not name otherwise, or is new. Marks without a name get a free
/// one. Marks that the list leaves out stay: it may be older than the last press. Throws Refusal if there would be more
/// than most_marks.
std::vector<ChangedMark> changed_marks(const std::vector<Point>& known, const std::vector<Point>& sent);

}  // namespace palpate::plugin::igtl
