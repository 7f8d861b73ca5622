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
#include "io/testing/short_files.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::OddArchive;
using testing::says;
using testing::ShortFiles;

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

TEST(OddArchive, ThatDoesNotKnowWhereToSendSaysWhatToEnter) {
  OddArchive odd("unknown-destination");
  odd.archive().uses_get = false;
  const std::string said = odd.refused_fetch();
  EXPECT_TRUE(says(said, "it does not know us as a place to send to: {}"));
  EXPECT_TRUE(says(said, "have {} entered there as a destination, with this machine's address and port {}"));
  EXPECT_THAT(said, HasSubstr(std::to_string(odd.archive().listen_port)));
}

TEST(OddArchive, ThatAnswersOtherThanAskedIsGivenUp) {
  EXPECT_TRUE(says(OddArchive("offers-nothing").refused_echo(),
                   "{} does not offer us this service ({}): have it allowed there for {}"));
  EXPECT_TRUE(says(OddArchive("refuses-echo").refused_echo(), "archive {} answered, and refused the echo: {}"));
  EXPECT_TRUE(says(OddArchive("garbage").refused_fetch(), "{} sent an answer that is no DICOM dataset"));
  EXPECT_TRUE(says(OddArchive("echoes").refused_fetch(), "archive {} gave an unexpected answer to a question"));
  EXPECT_TRUE(says(OddArchive("echoes-at-get").refused_fetch(), "it gave an unexpected answer"));
}

TEST(OddArchive, ThatHasNothingSaysSo) {
  EXPECT_TRUE(says(OddArchive("empty").refused_fetch(), "the archive has no images of it"));
  EXPECT_TRUE(says(OddArchive("all-fail").refused_fetch(), "all {} of its images failed"));
}

TEST(OddArchive, ThatAlsoSendsAnotherStudyIsToldOf) {
  OddArchive odd("partly-unasked");
  const Fetched fetched = fetch(odd.archive(), {"1.2.3"}, odd.folder());
  EXPECT_EQ(fetched.files, 1U);
  ASSERT_FALSE(fetched.warnings.empty());
  EXPECT_TRUE(
      says(fetched.warnings.front(), "archive {} also sent {} objects that were not asked for; they were not kept"));
}

// A file of 3 GB that is refused in its midst, and one so small that it waits in a buffer until it is closed.
TEST(OddArchive, MeetsAFullDisk) {
  for (const char* const behavior : {"without-end", "good"}) {
    OddArchive odd(behavior);
    std::string said;
    {
      const ShortFiles disk(behavior == std::string("good") ? 100 : 1U << 20U);
      said = odd.refused_fetch();
    }
    EXPECT_TRUE(says(
        said, "{} cannot be written ({}): make room, or name another folder with -o; nothing is left of this fetch"));
    EXPECT_THAT(said, HasSubstr("cannot be written (File too large)"))
        << "the limit of a file, which stands for a disk";
  }
  OddArchive odd("good");
  odd.no_folder();
  EXPECT_THAT(odd.refused_fetch(), HasSubstr("cannot be written (Not a directory)"));
}

TEST(OddArchive, ThatSendsElsewhereIsFoundOut) {
  OddArchive odd("sends-nothing");
  odd.archive().uses_get = false;
  EXPECT_TRUE(says(odd.refused_fetch(), "nothing arrived here: {}, and check that no firewall is between"));
}

/// What came of an image before its connection broke is no image.
TEST(OddArchive, ThatBreaksOffInAnImageHasNotSentIt) {
  OddArchive odd("breaks-off-at-move");
  odd.archive().uses_get = false;
  EXPECT_TRUE(says(odd.refused_fetch(), "nothing arrived here: {}, and check that no firewall is between"));
}

TEST(OddArchive, ThatFallsSilentWhileItShouldSendIsGivenUp) {
  OddArchive odd("falls-silent-at-move");
  odd.archive().uses_get = false;
  odd.archive().silence_s = 2;  // more than the second after which it is asked whether to go on
  EXPECT_TRUE(says(odd.refused_fetch(),
                   "{} has said nothing for {} s: it is too busy, or another program listens on that port"));
}

TEST(OddArchive, ThatSendsUnderAnotherTitleIsTurnedAway) {
  OddArchive odd("stranger");
  odd.archive().uses_get = false;
  EXPECT_TRUE(
      says(odd.refused_fetch(),
           "STRANGER{} when it sent, and was refused: --called has to be the archive's AE title, and --calling the "
           "title that it sends to"));
  EXPECT_EQ(odd.process().read_line(), "stranger 3 for 3")
      << "an A-ASSOCIATE-RJ: the caller is not known (PS3.8 9.3.4)";
  OddArchive misdials("misdials");
  misdials.archive().uses_get = false;
  EXPECT_TRUE(says(misdials.refused_fetch(), "ODD called us SOMEONE when it sent, and was refused"));
  EXPECT_EQ(misdials.process().read_line(), "stranger 3 for 7") << "the called one is not known";
}

TEST(OddArchive, ThatSendsAnotherStudyIsNotBelieved) {
  OddArchive odd("unasked");
  EXPECT_TRUE(says(odd.refused_fetch(), "it sent something else, which was not kept: tell its administrator"));
  EXPECT_THAT(odd.process().read_line(), HasSubstr("stored C000"));
}

TEST(OddArchive, ThatPutsPathsInUidsWritesNowhereElse) {
  OddArchive odd("paths");
  const Fetched fetched = fetch(odd.archive(), {"1.2.3"}, odd.folder());
  EXPECT_EQ(fetched.files, 2U);
  for (const auto& entry : fs::recursive_directory_iterator(odd.folder())) {
    const std::string name = entry.path().filename().string();
    EXPECT_TRUE(name.starts_with("series-") || name.starts_with("image-")) << name;
  }
  EXPECT_FALSE(fs::exists("/tmp/evil"));
  EXPECT_FALSE(fs::exists("/etc/evil"));
}

TEST(OddArchive, ThatFailsInPartIsCounted) {
  OddArchive odd("half");
  const Fetched fetched = fetch(odd.archive(), {"1.2.3"}, odd.folder());
  EXPECT_EQ(fetched.files, 1U);
  EXPECT_FALSE(fetched.complete);
  ASSERT_EQ(fetched.warnings.size(), 1U);
  EXPECT_THAT(fetched.warnings.front(), HasSubstr("3 of 4 images of study 1.2.3"));
  EXPECT_THAT(fetched.warnings.front(), HasSubstr("(1.2.3.6 1.2.3.7 1.2.3.8)"));
  EXPECT_TRUE(says(
      fetched.warnings.front(),
      "{} of {} images of {} could not be sent by archive {}{}: fetch it again, or tell the archive's administrator"));
}

/// Of many that failed a few are named, each of them whole, and in letters that can be shown.
TEST(OddArchive, ThatFailsMuchIsQuotedInPart) {
  OddArchive odd("fails-much");
  const Fetched fetched = fetch(odd.archive(), {"1.2.3"}, odd.folder());
  ASSERT_EQ(fetched.warnings.size(), 1U);
  const std::string said = fetched.warnings.front();
  EXPECT_THAT(said, HasSubstr("30 of 31 images"));
  const std::size_t open = said.find('('), shut = said.find(')', open);
  ASSERT_NE(shut, std::string::npos);
  const std::string words = said.substr(open + 1, shut - open - 1);
  EXPECT_LE(words.size(), 204U);
  EXPECT_GT(words.size(), 180U);
  std::string wanted = "1.2.3.10";
  for (int n = 11; n < 40; ++n) wanted += n == 12 ? " 1?" : " 1.2.3." + std::to_string(n);
  ASSERT_TRUE(words.ends_with(" ...")) << words;
  const std::string named = words.substr(0, words.size() - 4);
  EXPECT_TRUE(wanted.starts_with(named + " ")) << words;
}

/// What came is kept where the archive says how many it could not send, and not where it says nothing of it.
TEST(OddArchive, ThatGivesUpMidwayHasSentWhatItHas) {
  OddArchive counts("gives-up-midway");
  const Fetched fetched = fetch(counts.archive(), {"1.2.3"}, counts.folder());
  EXPECT_EQ(fetched.files, 1U);
  EXPECT_FALSE(fetched.complete);
  ASSERT_EQ(fetched.warnings.size(), 1U);
  EXPECT_THAT(fetched.warnings.front(), HasSubstr("2 of 3 images of study 1.2.3"));
  EXPECT_TRUE(says(OddArchive("stops-midway").refused_fetch(), "archive {} did not send {}: {}(status A702)"));
}

/// As many as are allowed may come, and not one more: files, and bytes of all of them.
TEST(OddArchive, MayComeUpToItsLimits) {
  OddArchive odd("good");
  const Fetched all = fetch(odd.archive(), {"1.2.3"}, odd.folder());
  ASSERT_EQ(all.files, 2U);
  // Five elements each, of eight bytes and a value: two UIDs of 8 bytes, one of 26 and one of 6, and a number of 2.
  EXPECT_EQ(all.bytes, 2U * (5 * 8 + 8 + 8 + 26 + 6 + 2));
  FetchLimits limits;
  limits.files = 2;
  limits.bytes = all.bytes;
  EXPECT_EQ(fetch(odd.archive(), {"1.2.3"}, odd.folder(), limits).files, 2U);
  OddArchive more("good"), larger("good");
  FetchLimits one_file, a_byte_less;
  one_file.files = 1;
  a_byte_less.bytes = all.bytes - 1;
  EXPECT_THAT(more.refused_fetch(one_file), HasSubstr("more than 1 files came"));
  EXPECT_THAT(larger.refused_fetch(a_byte_less), HasSubstr("MiB came"));
}

/// Another study's image, and one that came twice: when all has come, nothing else takes room.
TEST(OddArchive, LeavesNoImageThatIsNotKept) {
  for (const auto& [behavior, kept] : {std::pair{"good", 2U}, {"partly-unasked", 1U}}) {
    OddArchive odd(behavior);
    std::size_t files = 0, there = 0;
    fetch(odd.archive(), {"1.2.3"}, odd.folder(), {}, [&](const FetchProgress& progress) {
      files = progress.files;
      there = 0;
      for (const auto& entry : fs::recursive_directory_iterator(odd.folder())) there += entry.is_regular_file() ? 1 : 0;
      return true;
    });
    EXPECT_EQ(files, kept) << behavior;
    EXPECT_EQ(there, kept) << behavior << ", as the last word had it";
  }
}

TEST(OddArchive, ThatGrowsIsNoticed) {
  OddArchive odd("grows");
  const Fetched fetched = fetch(odd.archive(), {"1.2.3"}, odd.folder());
  ASSERT_EQ(fetched.warnings.size(), 1U);
  EXPECT_TRUE(says(fetched.warnings.front(),
                   "archive {} now holds {} images of {}, and {} came: it may still be growing; fetch it again"));
}

/// Whether a series has grown is asked at the end. All has come by then, whatever is answered.
TEST(OddArchive, ThatDoesNotAnswerAfterwardsTakesNothingBack) {
  for (const char* behavior : {"busy-afterwards", "forgets-afterwards"}) {
    OddArchive odd(behavior);
    const Fetched fetched = fetch(odd.archive(), {"1.2.3"}, odd.folder());
    EXPECT_EQ(fetched.files, 2U) << behavior;
    EXPECT_TRUE(fetched.complete);
    EXPECT_TRUE(fetched.warnings.empty());
  }
}

TEST(OddArchive, ThatIsOutOfResourcesIsQuoted) {
  EXPECT_TRUE(says(OddArchive("out-of-resources").refused_fetch(), "archive {} did not send {}: {}(status A702)"));
}

TEST(OddArchive, ThatDiesMidwayLeavesNothing) {
  EXPECT_TRUE(says(OddArchive("dies-midway").refused_fetch(), "the connection broke after {} images; fetch it again"));
}

TEST(OddArchive, ThatFallsSilentMidwayLeavesNothing) {
  OddArchive odd("falls-silent");
  odd.archive().silence_s = 1;
  EXPECT_TRUE(says(odd.refused_fetch(), "the connection broke after {} images; fetch it again"));
}

TEST(OddArchive, ThatSendsAByteAWhileIsGivenUp) {
  const auto begin = std::chrono::steady_clock::now();
  OddArchive odd("drips");
  odd.archive().silence_s = 1;
  EXPECT_TRUE(says(odd.refused_fetch(), "the connection broke after {} images; fetch it again"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(8));
}

TEST(OddArchive, ThatSendsWithoutEndIsBounded) {
  FetchLimits limits;
  limits.bytes = 64U << 20U;
  EXPECT_EQ(OddArchive("without-end").refused_fetch(limits),
            "more than 64 MiB came: fetch series by series, or allow more with --most-mib");
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

TEST(ArchiveSettings, ThatCannotBeAreRefused) {
  const Archive archive{.name = "a", .host = "h", .port = 104, .called = "CALLED", .calling = "US"};
  EXPECT_NO_THROW(check(archive));
  const auto refused = [&](const char* message, auto change) {
    Archive wrong = archive;
    change(wrong);
    try {
      check(wrong);
      ADD_FAILURE() << "not refused: " << message;
    } catch (const ArchiveError& error) {
      EXPECT_TRUE(says(error.what(), message));
      EXPECT_TRUE(std::string(error.what()).starts_with("archive a: ")) << error.what();
    }
  };
  refused("--host has to be a machine's name or address", [](Archive& a) { a.host = ""; });
  refused("a port is a number from 1 to 65535", [](Archive& a) { a.port = 65536; });
  refused("a port is a number from 1 to 65535", [](Archive& a) { a.listen_port = 0; });
  refused("an AE title has 1 to 16 letters, digits or signs", [](Archive& a) { a.called = "LONGER THAN SIXTEEN"; });
  refused("an AE title has 1 to 16 letters, digits or signs", [](Archive& a) { a.calling = "  "; });
  refused("an AE title has 1 to 16 letters, digits or signs", [](Archive& a) { a.calling = "A\\B"; });
  refused("the time to wait has to be 1 to 3600 s", [](Archive& a) { a.silence_s = 0; });
  refused("TLS needs --tls-ca, the certificate of the authority that signed the archive's certificate",
          [](Archive& a) { a.tls.used = true; });
  refused("C-MOVE with TLS needs --tls-certificate and --tls-key, since the archive then connects to us; or set --get",
          [](Archive& a) {
            a.tls = {true, "ca.pem", "", "", ""};
          });
  refused("--tls-certificate and --tls-key go together", [](Archive& a) {
    a.tls = {true, "ca.pem", "own.pem", "", ""};
  });
}

}  // namespace
}  // namespace palpate::io
