#pragma once

/// Checks that tests show a module's messages: each is provoked, or quoted in full by the test that meets it, or stands
/// in a list of those that cannot be provoked, with the reason.

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "solver/text/message.h"

namespace palpate::testing {

struct Provoked {
  std::string_view id;
  std::string said;
};

/// The message of the exception that `run` throws.
std::string said_when(const std::function<void()>& run);
/// All output of a shell command.
std::string output_of(const std::string& command);

struct NotShown {
  std::string_view id;
  std::string_view why;
};

/// Whether the fixed pieces of the message occur in the text, in their order.
bool fits(std::string_view message, std::string_view text);

/// Fails for each message of these tables that no test shows, for each that should have been provoked and did not
/// appear, and for each that was listed as impossible and did appear. `sources` is the root of the tree.
void expect_all_shown(const std::vector<std::span<const MessageRow>>& tables, std::span<const Provoked> provoked,
                      std::span<const NotShown> not_shown, const char* sources);

}  // namespace palpate::testing
