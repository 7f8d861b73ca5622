#pragma once

/// Prints the requests that an archive receives, line by line; a test compares them with the standard.

#include <string>

#include "io/archive/testing/dimse.h"

namespace palpate::io::testing {

/// The AE titles and the proposed contexts of an A-ASSOCIATE-RQ's body (PS3.8 9.3.2).
void tell_association(const std::string& request);
/// A command (PS3.7) and its keys, each on a line.
void tell_command(const Elements& command, const Elements& keys);

}  // namespace palpate::io::testing
