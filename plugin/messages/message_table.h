#pragma once

/// messages.md and the sources, as the test of messages reads them.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpate::plugin::testing {

/// The messages of the table, in their order: texts with {} (or %1, %n) for what differs.
std::vector<std::string> messages_of_table(const std::filesystem::path& markdown);

/// What of a message, or of a literal that is a format, is always the same: the pieces between what differs, trimmed.
std::vector<std::string> fixed_pieces(std::string_view text);

/// Whether the pieces of the message stand in the text, in their order.
bool fits(std::string_view message, std::string_view text);

struct Literal {
  std::string text;
  std::string where;  ///< file:line
};

/// The literals of all statements that tell a user something: what is thrown, refused, warned of, or printed to stderr.
/// Of the folders' own sources, not of their tests.
std::vector<Literal> literals_that_tell(const std::filesystem::path& sources);

/// Every literal of those sources, one a line.
std::string all_literals(const std::filesystem::path& sources);

/// The same of the tests' sources that meet messages outside this program: tests in C++ and in Python, the panel's.
std::string all_literals_of_tests(const std::filesystem::path& sources);

/// Whether it is words, and not a key or a number's unit.
bool is_a_phrase(std::string_view piece);

}  // namespace palpate::plugin::testing
