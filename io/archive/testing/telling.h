#pragma once

/// Prints what an archive is asked, line by line: what a test compares with the standard.

#include <string>

#include "io/archive/testing/dimse.h"

namespace palpate::io::testing {

/// Who calls whom, and the contexts that are offered: an A-ASSOCIATE-RQ's body (PS3.8 9.3.2).
void tell_association(const std::string& request);
/// A command (PS3.7) and its keys, each in a line of its own.
void tell_command(const Elements& command, const Elements& keys);

}  // namespace palpate::io::testing
