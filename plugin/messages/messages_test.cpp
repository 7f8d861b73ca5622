// The page against its tables, the tables against the sources that use their messages, and each message of the programs
// and the panel in its final form.

#include "plugin/messages/messages.h"
#include "plugin/messages/messages_of_openigtlink.h"

#include <gtest/gtest.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "device/messages.h"
#include "io/messages.h"
#include "modes/messages.h"
#include "plugin/messages/page.h"
#include "plugin/messages/provoked.h"
#include "solver/messages.h"
#include "solver/text/testing/shown.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;
using palpate::testing::NotShown;
using palpate::testing::Provoked;

const fs::path sources = PALPATE_SOURCES;

std::string content_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Calls look(file, content) for each source that is not a test's, a benchmark's or a table.
template <typename Look>
void for_sources(const Look& look) {
  static const std::regex left_out("_test\\.|_benchmark\\.|/tests/|/testing/|/peers/|/fuzz/|/examples/|messages");
  for (const char* const folder : {"io", "modes", "solver", "device", "plugin"}) {
    for (const auto& entry : fs::recursive_directory_iterator(sources / folder)) {
      const std::string extension = entry.path().extension().string();
      const std::string file = fs::relative(entry.path(), sources).string();
      if ((extension == ".cpp" || extension == ".h") && !std::regex_search(file, left_out)) {
        look(file, content_of(entry.path()));
      }
    }
  }
}

TEST(Messages, ThePageIsMadeOfTheTables) {
  EXPECT_EQ(content_of(sources / "plugin/docs/messages.md"), message_page())
      << "write it anew: ninja -C build messages_page";
}

TEST(Messages, EachSaysWhyItComesAndWhatToDoAndIsSaid) {
  std::string all;
  for_sources([&](const std::string& /*file*/, const std::string& content) { all += content; });
  ASSERT_GT(all.size(), 500'000U) << "the sources are not where they are looked for: " << sources;
  for (const MessageSection& section : message_sections()) {
    for (const auto& table : section.tables) {
      for (const MessageRow& row : table) {
        EXPECT_FALSE(row.why.empty() && row.what_to_do.empty()) << row.messages[0].text;
        EXPECT_EQ(row.why.find('|'), std::string_view::npos) << "it would end its cell: " << row.why;
        for (const Message& message : row.messages) {
          if (message.id.empty()) continue;
          EXPECT_NE(all.find('"' + std::string(message.id) + '"'), std::string::npos)
              << "nothing says " << message.id << ": take it out of its table";
        }
      }
    }
  }
}

// Of one id in two tables that a call looks through, the last would be said.
TEST(Messages, NoFolderHasAnIdTwice) {
  const std::vector<std::vector<std::span<const MessageRow>>> folders{
      {io::messages::archives, io::messages::series, io::messages::structures},
      {modes::messages::scenes},
      {solver::messages::balances},
      {device::messages::styluses},
      {messages::kept_archives, messages::balances, messages::openigtlink, messages::paraview, messages::choices,
       messages::sessions, messages::scene_structures}};
  for (const auto& tables : folders) {
    std::set<std::string_view> ids;
    for (const auto& table : tables) {
      for (const MessageRow& row : table) {
        for (const Message& message : row.messages) {
          EXPECT_TRUE(message.id.empty() || ids.insert(message.id).second) << message.id;
        }
      }
    }
  }
}

// The types see to most of it: a refusal is made of a Text, and a Text comes from a table. What the standard library's
// errors and streams take has to be looked for.
TEST(Messages, NoSourceTellsAUserWordsOfItsOwn) {
  static const std::regex own_words(
      "(throw std::(runtime_error|invalid_argument)\\([^;]{0,200}?|print\\(stderr,\\s*|fputs\\(\\s*|"
      "(tell|told|refused)\\(\\s*tr\\(\\s*|notes << tr\\(\\s*)\"[^\"]*[A-Za-z]{2,} [A-Za-z]{2,}");
  for_sources([&](const std::string& file, const std::string& content) {
    for (std::sregex_iterator found(content.begin(), content.end(), own_words), end; found != end; ++found) {
      ADD_FAILURE() << file << " says " << found->str() << "\": give it a row in the folder's messages.h";
    }
  });
}

constexpr const char* a_solver_at_fault =
    "every answer is checked before it is told; no input is known whose answer fails";
constexpr const char* a_fault = "a fault of the program, of which none is known";
constexpr const char* of_paraview = "met in ParaView, by tests that look at what comes of it and not at the words";
constexpr std::array not_shown{
    NotShown{"answer-is-not-finite", a_solver_at_fault},
    NotShown{"no-answer-with-a-finite-error-bound", a_solver_at_fault},
    NotShown{"hard-constraints-disagree", a_solver_at_fault},
    NotShown{"archive-holds-more", "an archive of more than a hundred studies; the command line's is shown"},
    NotShown{"cannot-be-deleted", "it lies in a folder of the user's own, and root may all"},
    NotShown{"make-a-table", "HDF5 has no memory left"},
    NotShown{"soak-found-a-fault", "a servo at fault"},
    NotShown{"no-start-without-thread-caches", "a program that cannot be started, and runs"},
    NotShown{"several-ranks-do-not-filter", "a reader of several ranks is not driven through the panel's filter"},
    NotShown{"internal-fault", a_fault},
    NotShown{"please-report-it-with-the-command", a_fault},
    NotShown{"paraview-is-not-connected-to-a-server", of_paraview},
    NotShown{"server-cannot-give-the-scan-voxels", of_paraview},
    NotShown{"does-not-answer", of_paraview},
    NotShown{"scan-left-the-server", of_paraview},
    NotShown{"voxels-did-not-arrive", of_paraview},
    NotShown{"server-cannot-give-the-structures", of_paraview},
    NotShown{"structures-did-not-arrive", of_paraview},
    NotShown{"this-machine-has-not-enough-memory", of_paraview},
    NotShown{"fetched-from-the-server-before", of_paraview},
    NotShown{"left-the-server", of_paraview},
    NotShown{"paraview-session-ended", of_paraview},
    NotShown{"scan-is-still-being-read", of_paraview},
    NotShown{"boundary-is-another-one", of_paraview},
    NotShown{"views-show-another-scan", of_paraview},
    NotShown{"no-place-outside-the-patient", of_paraview},
    NotShown{"this-series-could-not-be-read", of_paraview},
    NotShown{"this-series-has-no-values", of_paraview},
    NotShown{"it-has-no-readable-images", of_paraview},
    NotShown{"marks-need-the-images", of_paraview},
    NotShown{"outline-needs-the-images", of_paraview},
};

TEST(Messages, EachIsShown) {
  std::vector<Provoked> provoked;
  for (const auto& some : {testing::provoke_balances(), testing::provoke_openigtlink(), testing::provoke_programs(),
                           testing::provoke_recordings()}) {
    provoked.insert(provoked.end(), some.begin(), some.end());
  }
  palpate::testing::expect_all_shown(
      {messages::kept_archives, messages::balances, messages::openigtlink, messages::paraview, messages::choices,
       messages::sessions, messages::scene_structures},
      provoked, not_shown, PALPATE_SOURCES);
}

}  // namespace
}  // namespace palpate::plugin
