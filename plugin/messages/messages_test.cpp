// messages.md against the program, both ways: what stands in the table is said by the sources and by the program when
// it is provoked, and what the sources tell a user stands in the table.

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstdio>
#include <string>
#include <vector>

#include "device/messages.h"
#include "plugin/messages/message_table.h"
#include "plugin/messages/provoked.h"

namespace palpate::plugin {
namespace {

using testing::fixed_pieces;

const std::filesystem::path sources = PALPATE_SOURCES;

const std::vector<std::string>& table() {
  // The folders whose refusals are made of their tables show their messages themselves.
  static const std::vector<std::string> messages = [] {
    std::vector<std::string> all = testing::messages_of_table(sources / "plugin/docs/messages.md");
    for (const MessageRow& row : device::messages::styluses) {
      for (const Message& message : row.messages) std::erase(all, message.text);
    }
    return all;
  }();
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
          << "\": give it a row in plugin/docs/messages.md, with why it comes and what to do";
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

constexpr const char* a_solver_at_fault =
    "every answer is checked before it is told; no input is known whose answer fails";
constexpr const char* of_paraview = "met in ParaView, by tests that look at what comes of it and not at the words";

/// What no test shows, and why.
struct NotShown {
  const char* message;
  const char* why;
};
const std::vector<NotShown> not_shown = {
    NotShown{"the answer is not finite: the numbers given are too large to be computed with", a_solver_at_fault},
    NotShown{"no answer with a finite error bound was found", a_solver_at_fault},
    NotShown{": has infinite strength, but the best answer found stays {} m away: the hard constraints seem to have no "
             "common point",
             a_solver_at_fault},
    NotShown{"archive {}: the OpenSSL that is installed cannot do TLS 1.2", "an OpenSSL of ten years ago"},
    NotShown{"{} cannot be deleted ({}): delete it by hand", "it lies in a folder of the user's own, and root may all"},
    NotShown{"make a table", "HDF5 has no memory left"},
    NotShown{"the soak found what may not be: see above", "a servo at fault"},
    NotShown{"palpate: could not start again without thread caches; the heap's figures are off by what they hold",
             "a program that cannot be started, and runs"},
    NotShown{"a server of several ranks does not filter: clear the reader's Filter, or use one rank",
             "a reader of several ranks is not driven through the panel's filter"},
    NotShown{"{}: internal fault: {}", "a fault of the program, of which none is known"},
    NotShown{"Please report it with the command that caused it.", "a fault of the program, of which none is known"},
    NotShown{"ParaView is not connected to a server: File > Connect.", of_paraview},
    NotShown{"The server cannot give the scan's voxels: %1", of_paraview},
    NotShown{"it does not answer, and needs the Palpate plug-in of this version", of_paraview},
    NotShown{"The scan is no longer on the server.", of_paraview},
    NotShown{"The voxels did not arrive as the server sent them: open the scan again.", of_paraview},
    NotShown{"This machine has not enough memory for the scan, which has to be felt here.", of_paraview},
    NotShown{"Fetched from the server before.", of_paraview},
    NotShown{"ParaView left the server: the stylus was let go.", of_paraview},
    NotShown{"ParaView's session ended, and the scan went with it. Open a scan, then press Feel", of_paraview},
    NotShown{"the scan is still being read. Wait until it is shown, then press Feel", of_paraview},
    NotShown{"the views show %1, and the stylus has %2. Go back to that one, then press Feel", of_paraview},
    NotShown{"No place outside the patient is in reach: the stylus begins inside. Choose Reach: Scan before you press "
             "Feel.",
             of_paraview},
    NotShown{"this series could not be read: see the messages", of_paraview},
    NotShown{"this series has no values: see the messages", of_paraview},
};

std::vector<bool> shown_by(const std::vector<testing::Provoked>& provoked) {
  std::vector<bool> shown(table().size());
  for (const testing::Provoked& one : provoked) {
    const bool said = !fixed_pieces(one.wanted).empty() && testing::fits(one.wanted, one.said);
    EXPECT_TRUE(said) << "wanted: " << one.wanted << "\nsaid: " << one.said;
    EXPECT_TRUE(std::ranges::count(table(), one.wanted) > 0) << "no row of the table: " << one.wanted;
    for (std::size_t n = 0; n < table().size(); ++n) shown[n] = shown[n] || (said && table()[n] == one.wanted);
  }
  return shown;
}

// The words themselves, here, or quoted in full by the test that meets them in its own place.
TEST(Messages, EveryRowIsShownByATest) {
  const std::vector<bool> provoked = shown_by(testing::provoke_everything());
  const std::string quoted = testing::all_literals_of_tests(sources);
  std::size_t here = 0, elsewhere = 0, never = 0;
  for (std::size_t n = 0; n < table().size(); ++n) {
    const std::string& message = table()[n];
    const std::vector<std::string> pieces = fixed_pieces(message);
    const bool is_quoted =
        std::ranges::all_of(pieces, [&](const std::string& piece) { return quoted.find(piece) != std::string::npos; });
    const auto reason = std::ranges::find(not_shown, message, &NotShown::message);
    if (provoked[n]) {
      ++here;
      EXPECT_EQ(reason, not_shown.end()) << "it can be shown: " << message;
    } else if (reason != not_shown.end()) {
      ++never;
      std::printf("  shown by no test: %s (%s)\n", message.c_str(), reason->why);
    } else if (is_quoted) {
      ++elsewhere;
    } else if (!testing::cannot_be_had_here(message)) {
      ADD_FAILURE() << "no test shows the row " << message
                    << ": provoke it in plugin/internal/provoked_*.cpp, quote it in the test that meets it, or say in "
                       "not_shown why it cannot be had";
    }
  }
  std::printf("%zu messages in the table: %zu provoked here, %zu met by other tests, %zu shown by none\n",
              table().size(), here, elsewhere, never);
}

}  // namespace
}  // namespace palpate::plugin
