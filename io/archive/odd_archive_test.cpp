// Messages and leftovers when an archive misbehaves: testing/odd_archive_main.cpp, a program of its own.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <utility>

#include "io/archive/archive.h"
#include "io/archive/fetch.h"
#include "io/archive/find.h"
#include "io/archive/send.h"
#include "io/archive/testing/made_series.h"
#include "io/archive/testing/odd_archive.h"
#include "io/archive/testing/says.h"
#include "io/errors.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::OddArchive;
using testing::says;

TEST(OddArchive, ThatBehavesIsFetchedFrom) {
  OddArchive odd("good");
  const Fetched fetched = fetch(odd.archive(), {"1.2.3"}, odd.folder());
  EXPECT_EQ(fetched.files, 2U) << "one came twice";
  EXPECT_TRUE(fetched.warnings.empty());
}

TEST(OddArchive, ThatIsNotThereCannotBeReached) {
  Archive nowhere;
  nowhere.name = "nowhere";
  nowhere.host = "127.0.0.1";
  nowhere.port = testing::free_port();
  nowhere.called = nowhere.calling = "X";
  EXPECT_THROW(
      {
        try {
          echo(nowhere);
        } catch (const ArchiveError& error) {
          EXPECT_TRUE(
              says(error.what(),
                   "{} cannot be reached (connection refused): check --host and --port, and that no firewall is "
                   "between"));
          throw;
        }
      },
      ArchiveError);
}

TEST(OddArchive, ThatHasNoAddressIsSaid) {
  Archive unknown{.name = "a", .host = "no-such-machine.invalid", .port = 104, .called = "CALLED", .calling = "US"};
  try {
    echo(unknown);
    ADD_FAILURE() << "not refused";
  } catch (const ArchiveError& error) {
    EXPECT_TRUE(says(error.what(), "{}: no machine of that name is known: check --host"));
  }
}

TEST(OddArchive, ThatRefusesIsQuoted) {
  EXPECT_TRUE(
      says(OddArchive("wrong-called").refused_echo(), "{} is not known there as {}: set --called to its own AE title"));
  EXPECT_TRUE(says(
      OddArchive("wrong-calling").refused_echo(),
      "{} does not know us as {}: have this AE title entered there with this machine's address, or set --calling"));
  EXPECT_TRUE(says(
      OddArchive("refuse").refused_echo(),
      "{} refused the association and did not say why: check --called ({}), and that --calling ({}) is known there"));
  EXPECT_TRUE(says(OddArchive("busy").refused_echo(), "{} is too busy to talk to us: try again later"));
}

TEST(OddArchive, ThatIsNoneIsToldFromOne) {
  EXPECT_TRUE(says(OddArchive("not-dicom").refused_echo(),
                   "{} broke the connection off: it ended, or does not speak DICOM{} on that port"));
  OddArchive secure("not-dicom");
  secure.archive().tls = {true, "/no/such.pem", "", "", ""};
  const std::string said = secure.refused_echo();
  EXPECT_TRUE(says(said,
                   "archive {}: {} {} cannot be used for TLS: it has to be a readable file in PEM; give the right one "
                   "with `palpate archive add`"));
  EXPECT_THAT(said, HasSubstr("archive odd: --tls-ca /no/such.pem cannot"));
}

TEST(OddArchive, ThatIsSilentIsGivenUp) {
  OddArchive silent("silent");
  silent.archive().silence_s = 1;
  const auto begin = std::chrono::steady_clock::now();
  EXPECT_TRUE(says(silent.refused_echo(),
                   "{} has said nothing for {} s: it is too busy, or another program listens on that port"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(5));
}

TEST(OddArchive, ThatRefusesToFindSaysWhy) {
  EXPECT_TRUE(says(OddArchive("refuses-find").refused_fetch(), "archive {} refused the question: {}"));
  EXPECT_TRUE(says(OddArchive("cancels-itself").refused_fetch(), "archive {} refused the question: {}"))
      << "nobody had asked it to end";
  for (const char* const behavior : {"dies-at-find", "dies-in-an-answer"}) {
    EXPECT_TRUE(says(OddArchive(behavior).refused_fetch(),
                     "{} broke the connection off: it ended, or does not speak DICOM{} on that port"))
        << behavior;
  }
  EXPECT_TRUE(says(OddArchive("huge-answer").refused_fetch(),
                   "{} sent an answer of more than {} bytes, which cannot be right"));
}

TEST(OddArchive, ThatFindsWithoutEndIsStopped) {
  OddArchive odd("endless-find");
  ArchiveQuery query;
  query.most_studies = 5;
  query.with_series = false;
  const Found found = find(odd.archive(), query);
  EXPECT_EQ(found.studies.size(), 5U);
  EXPECT_TRUE(found.more);
  EXPECT_THAT(odd.process().read_line(), HasSubstr("canceled 0FFF"));
  EXPECT_EQ(found.studies.front().patient, "M\xC3\xBCller^Zo\xC3\xAB") << "Latin-1 as UTF-8";
}

TEST(OddArchive, ThatAnswersNothingHasNotSaidTooMuch) {
  OddArchive odd("says-nothing");
  EXPECT_NO_THROW(find(odd.archive(), {.with_series = false}));
  OddArchive pends("pends-without-data");
  EXPECT_TRUE(find(pends.archive(), {.with_series = false}).studies.empty());
}

// PS3.4 B.2.3: the archive has the file, and what it says of it is said.
TEST(OddArchive, ThatTakesAFileWithAWarningIsQuoted) {
  const fs::path file = fs::directory_iterator(testing::made_series() / testing::ct)->path();
  for (const auto& [behavior, words] :
       {std::pair{"changes-at-store", "done, with failures or changes (status B000)"},
        {"leaves-out-at-store", "it left elements out (status B006)"},
        {"doubts-at-store", "it finds that the data do not fit their kind of object (status B007)"}}) {
    OddArchive warns(behavior);
    const Sent sent = send(warns.archive(), {file});
    EXPECT_EQ(sent.files, 1U);
    EXPECT_TRUE(sent.not_sent.empty());
    ASSERT_EQ(sent.warned.size(), 1U);
    EXPECT_EQ(sent.warned[0].file, file);
    EXPECT_TRUE(says(sent.warned[0].why, "archive {} took it, with a warning: {}"));
    EXPECT_TRUE(std::string(sent.warned[0].why).ends_with(words)) << sent.warned[0].why;
  }
}

// Spaces at either end are no part of an AE title (PS3.5 6.2): by C-MOVE the archive sends without them, and is told
// where to without them.
TEST(OddArchive, IsKnownWhateverSpacesItsTitleIsTypedWith) {
  for (const char* const spaces : {"{} ", " {}", "  {}  "}) {
    for (const bool uses_get : {false, true}) {
      for (std::string Archive::*const which : {&Archive::called, &Archive::calling}) {
        OddArchive odd(uses_get ? "good" : "tells-all");
        odd.archive().uses_get = uses_get;
        std::string typed = spaces;
        odd.archive().*which = typed.replace(typed.find("{}"), 2, odd.archive().*which);
        EXPECT_EQ(fetch(odd.archive(), {"1.2.3"}, odd.folder()).files, uses_get ? 2U : 1U) << spaces;
        if (uses_get) continue;
        std::string line;
        while (line.find("destination") == std::string::npos) line = odd.process().read_line();
        EXPECT_TRUE(line.ends_with("destination PALPATE")) << line;
      }
    }
  }
}

TEST(OddArchive, ThatDoesNotTakeAFileIsQuoted) {
  const fs::path file = fs::directory_iterator(testing::made_series() / testing::ct)->path();
  OddArchive refuses("refuses-store");
  const Sent sent = send(refuses.archive(), {file});
  EXPECT_EQ(sent.files, 0U);
  ASSERT_EQ(sent.not_sent.size(), 1U);
  EXPECT_TRUE(says(sent.not_sent.front().why, "archive {} did not take it: {}"));
  OddArchive offers_nothing("offers-nothing");
  EXPECT_TRUE(says(send(offers_nothing.archive(), {file}).not_sent.at(0).why, "archive {} does not take {} as {}"));
  OddArchive odd("echoes-at-store");
  try {
    send(odd.archive(), {file});
    ADD_FAILURE() << "not refused";
  } catch (const ArchiveError& error) {
    EXPECT_TRUE(says(error.what(), "archive {} gave an unexpected answer to a file"));
  }
}

}  // namespace
}  // namespace palpate::io
