#pragma once

/// The marks of clients among those of the session.

#include <cstddef>
#include <vector>

#include "plugin/openigtlink/contents.h"

namespace palpate::plugin::igtl {

/// In a message, and in a session to which a client adds.
inline constexpr std::size_t most_marks = 1024;

/// The marks of a client's list that are new or were moved, each under the name of the mark that it replaces or that it
/// is to become. Marks without a name get a free one. Marks that the list leaves out stay: it may be older than the
/// last press. Throws Refusal if there would be more than most_marks.
std::vector<Point> changed_marks(const std::vector<Point>& known, const std::vector<Point>& sent);

}  // namespace palpate::plugin::igtl
