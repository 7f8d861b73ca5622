#pragma once

/// Prints the requests to an archive line by line, so that a test can compare them with the standard.

#include <string>

#include "io/archive/testing/dimse.h"

namespace palpate::io::testing {

/// The body of an A-ASSOCIATE-RQ (PS3.8 9.3.2): both AE titles and the proposed contexts.
void tell_association(const std::string& request);
/// A command (PS3.7) and its keys, each on a line.
void tell_command(const Elements& command, const Elements& keys);

}  // namespace palpate::io::testing
