// MESSAGES.md against the program, both ways: what stands in the table is said by the sources and by the program when
// it is provoked, and what the sources tell a user stands in the table.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "palpate/plugin/internal/message_table.h"
#include "palpate/plugin/internal/provoked.h"

namespace palpate::plugin {
namespace {

using testing::fixed_pieces;

const std::filesystem::path sources = PALPATE_SOURCES;

const std::vector<std::string>& table() {
  static const std::vector<std::string> messages = testing::messages_of_table(sources / "plugin/MESSAGES.md");
  return messages;
}

/// What only a fault of ours can bring: the caller in our own sources gave what may not be. The program then says
/// "internal fault".
constexpr std::array never_told = {
    "histogram: the bins of the",
    "are empty",
    "a gradient needs a volume",
    "fields need a volume",
    "a tick has to last between 10 us and 1 s",
    ": as many states as poses are needed",
    "gradient magnitudes",
    // Names, and the heading that a warning of the table comes under.
    "subdivision.most_halts",
    "subdivision.most",
    "extremes.csv",
    "palpate: warning:",
};

TEST(Messages, WhatTheSourcesTellStandsInTheTable) {
  ASSERT_GT(table().size(), 100U);
  std::string all;
  for (const std::string& message : table()) {
    for (const std::string& piece : fixed_pieces(message)) all += piece + "\n";
  }
  std::size_t told = 0;
  for (const testing::Literal& literal : testing::literals_that_tell(sources)) {
    for (const std::string& piece : fixed_pieces(literal.text)) {
      if (!testing::is_a_phrase(piece) || std::find(never_told.begin(), never_told.end(), piece) != never_told.end()) {
        continue;
      }
      ++told;
      EXPECT_NE(all.find(piece), std::string::npos)
          << literal.where << " tells a user \"" << piece
          << "\": give it a row in plugin/MESSAGES.md, with why it comes and what to do";
    }
  }
  EXPECT_GT(told, 200U) << "the sources are not where they are looked for: " << sources;
}

TEST(Messages, WhatStandsInTheTableIsInTheSources) {
  const std::string all = testing::all_literals(sources);
  for (const std::string& message : table()) {
    for (const std::string& piece : fixed_pieces(message)) {
      EXPECT_NE(all.find(piece), std::string::npos) << "no source says \"" << piece << "\" of the row " << message;
    }
  }
}

TEST(Messages, WhatIsProvokedIsSaidInTheTablesWords) {
  std::size_t said = 0;
  std::vector<bool> shown(table().size());
  for (const testing::Provoked& one : testing::provoke_everything()) {
    bool found = false;
    for (std::size_t n = 0; n < table().size(); ++n) {
      if (!testing::fits(table()[n], one.said) || fixed_pieces(table()[n]).empty()) continue;
      found = true;
      shown[n] = true;
    }
    // The row it was provoked for, whatever else stands in what was said.
    const bool as_wanted =
        testing::fits(one.wanted, one.said) && std::count(table().begin(), table().end(), one.wanted);
    EXPECT_TRUE(found && as_wanted) << "wanted: " << one.wanted << "\nsaid: " << one.said;
    ++said;
  }
  EXPECT_GT(said, 80U);
  const auto count = std::count(shown.begin(), shown.end(), true);
  constexpr int most_so_far = 165;
  EXPECT_GE(count, most_so_far) << "a message that was shown here no longer is";
  std::printf("%zu messages in the table, %td of them provoked here\n", table().size(), count);
  for (std::size_t n = 0; n < table().size(); ++n) {
    if (!shown[n]) std::printf("  not provoked here: %s\n", table()[n].c_str());
  }
}

}  // namespace
}  // namespace palpate::plugin
