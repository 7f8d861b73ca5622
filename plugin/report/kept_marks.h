#pragma once

/// Marks of several scans as one text, for state files, traces and the undo stack.

#include <map>
#include <string>

#include "plugin/recording/marks.h"

namespace palpate::plugin {

/// Keyed by hash_of_series() of the scan that they are on.
using MarksOfScans = std::map<std::string, Marks>;

/// JSON; empty if there is no mark. Lengths, distances and angles are left out, because they follow from the places.
std::string kept_text(const MarksOfScans& marks);
/// Reads that text; an empty text has no marks. Throws InvalidInput that says what cannot be read.
MarksOfScans marks_of_text(const std::string& text);

}  // namespace palpate::plugin
