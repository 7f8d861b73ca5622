#pragma once

/// Whether a module's messages are shown by tests: each is provoked, or quoted in full by the test that meets it, or
/// stands in a list of those that cannot be had, with the reason.

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

/// What the exception says that comes of it.
std::string said_when(const std::function<void()>& run);
/// All that a command of the shell says.
std::string output_of(const std::string& command);

struct NotShown {
  std::string_view id;
  std::string_view why;
};

/// Whether the fixed pieces of the message stand in the text, in their order.
bool fits(std::string_view message, std::string_view text);

/// A failure for each message of these tables that no test shows, for each that was provoked and was not said, and for
/// each that cannot be had and was. `sources` is the root of the tree.
void expect_all_shown(const std::vector<std::span<const MessageRow>>& tables, std::span<const Provoked> provoked,
                      std::span<const NotShown> not_shown, const char* sources);

}  // namespace palpate::testing
