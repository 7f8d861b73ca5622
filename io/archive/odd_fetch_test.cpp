// What is kept and told of a fetch when an archive misbehaves: testing/odd_archive_main.cpp, a program of its own.

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <iterator>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "io/archive/archive.h"
#include "io/archive/fetch.h"
#include "io/archive/find.h"
#include "io/archive/send.h"
#include "io/archive/testing/odd_archive.h"
#include "io/archive/testing/says.h"
#include "io/testing/short_files.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using testing::OddArchive;
using testing::says;
using testing::ShortFiles;

TEST(OddFetch, ThatDoesNotKnowWhereToSendSaysWhatToEnter) {
  OddArchive odd("unknown-destination");
  odd.archive().uses_get = false;
  const std::string said = odd.refused_fetch();
  EXPECT_TRUE(says(said, "it does not know us as a place to send to: {}"));
  EXPECT_TRUE(says(said, "have {} entered there as a destination, with this machine's address and port {}"));
  EXPECT_THAT(said, HasSubstr(std::to_string(odd.archive().listen_port)));
}

TEST(OddFetch, ThatAnswersOtherThanAskedIsGivenUp) {
  EXPECT_TRUE(says(OddArchive("offers-nothing").refused_echo(),
                   "{} does not offer us this service ({}): have it allowed there for {}"));
  EXPECT_TRUE(says(OddArchive("refuses-echo").refused_echo(), "archive {} answered, and refused the echo: {}"));
  EXPECT_TRUE(says(OddArchive("garbage").refused_fetch(), "{} sent an answer that is no DICOM dataset"));
  EXPECT_TRUE(says(OddArchive("echoes").refused_fetch(), "archive {} gave an unexpected answer to a question"));
  EXPECT_TRUE(says(OddArchive("echoes-at-get").refused_fetch(), "it gave an unexpected answer"));
}

TEST(OddFetch, ThatHasNothingSaysSo) {
  EXPECT_TRUE(says(OddArchive("empty").refused_fetch(), "the archive has no images of it"));
  EXPECT_TRUE(says(OddArchive("all-fail").refused_fetch(), "all {} of its images failed"));
}

TEST(OddFetch, ThatAlsoSendsAnotherStudyIsToldOf) {
  OddArchive odd("partly-unasked");
  const Fetched fetched = fetch(odd.archive(), {"1.2.3"}, odd.folder());
  EXPECT_EQ(fetched.files, 1U);
  ASSERT_FALSE(fetched.warnings.empty());
  EXPECT_TRUE(
      says(fetched.warnings.front(), "archive {} also sent {} objects that were not asked for; they were not kept"));
}

// A file of 3 GB that is refused in its midst, and one so small that it waits in a buffer until it is closed.
TEST(OddFetch, MeetsAFullDisk) {
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

TEST(OddFetch, ThatSendsElsewhereIsFoundOut) {
  OddArchive odd("sends-nothing");
  odd.archive().uses_get = false;
  EXPECT_TRUE(says(odd.refused_fetch(), "nothing arrived here: {}, and check that no firewall is between"));
}

/// What came of an image before its connection broke is no image.
TEST(OddFetch, ThatBreaksOffInAnImageHasNotSentIt) {
  OddArchive odd("breaks-off-at-move");
  odd.archive().uses_get = false;
  EXPECT_TRUE(says(odd.refused_fetch(), "nothing arrived here: {}, and check that no firewall is between"));
}

TEST(OddFetch, ThatFallsSilentWhileItShouldSendIsGivenUp) {
  OddArchive odd("falls-silent-at-move");
  odd.archive().uses_get = false;
  odd.archive().silence_s = 2;  // more than the second after which it is asked whether to go on
  EXPECT_TRUE(says(odd.refused_fetch(),
                   "{} has said nothing for {} s: it is too busy, or another program listens on that port"));
}

TEST(OddFetch, ThatSendsUnderAnotherTitleIsTurnedAway) {
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

TEST(OddFetch, ThatSendsAnotherStudyIsNotBelieved) {
  OddArchive odd("unasked");
  EXPECT_TRUE(says(odd.refused_fetch(), "it sent something else, which was not kept: tell its administrator"));
  EXPECT_THAT(odd.process().read_line(), HasSubstr("stored C000"));
}

TEST(OddFetch, ThatPutsPathsInUidsWritesNowhereElse) {
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

/// What is said of a fetch of which one image came.
std::string told_of_one_image(const char* behavior) {
  OddArchive odd(behavior);
  const Fetched fetched = fetch(odd.archive(), {"1.2.3"}, odd.folder());
  EXPECT_EQ(fetched.files, 1U);
  EXPECT_FALSE(fetched.complete);
  EXPECT_EQ(fetched.warnings.size(), 1U);
  return fetched.warnings.empty() ? std::string() : std::string(fetched.warnings.front());
}

TEST(OddFetch, ThatFailsInPartIsCounted) {
  const std::string told = told_of_one_image("half");
  EXPECT_THAT(told, HasSubstr("3 of 4 images of study 1.2.3"));
  EXPECT_THAT(told, HasSubstr("(1.2.3.6 1.2.3.7 1.2.3.8)"));
  EXPECT_TRUE(says(
      told,
      "{} of {} images of {} could not be sent by archive {}{}: fetch it again, or tell the archive's administrator"));
}

/// Of many that failed a few are named, each of them whole, and in letters that can be shown.
TEST(OddFetch, ThatFailsMuchIsQuotedInPart) {
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
  for (int n = 11; n < 40; ++n) wanted += n == 12 || n == 13 ? " 1?" : " 1.2.3." + std::to_string(n);
  ASSERT_TRUE(words.ends_with(" ...")) << words;
  const std::string named = words.substr(0, words.size() - 4);
  EXPECT_TRUE(wanted.starts_with(named + " ")) << words;
}

/// What came is kept where the archive says how many it could not send, and not where it says nothing of it.
TEST(OddFetch, ThatGivesUpMidwayHasSentWhatItHas) {
  EXPECT_THAT(told_of_one_image("gives-up-midway"), HasSubstr("1 of 2 images of study 1.2.3"));
  EXPECT_TRUE(says(OddArchive("stops-midway").refused_fetch(), "archive {} did not send {}: {}(status A702)"));
}

/// As many as are allowed may come, and not one more: files, and bytes of all of them.
TEST(OddFetch, MayComeUpToItsLimits) {
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
TEST(OddFetch, LeavesNoImageThatIsNotKept) {
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

TEST(OddFetch, ThatGrowsIsNoticed) {
  OddArchive odd("grows");
  const Fetched fetched = fetch(odd.archive(), {"1.2.3"}, odd.folder());
  ASSERT_EQ(fetched.warnings.size(), 1U);
  EXPECT_TRUE(says(fetched.warnings.front(),
                   "archive {} now holds {} images of {}, and {} came: it may still be growing; fetch it again"));
}

/// What comes of a study, and how many images it is said to have; of 0 nothing is said.
struct OfStudy {
  int sent = 0, unasked = 0, failed = 0, count = 0;

  std::string uid() const {
    std::string uid = "1.2.3";
    for (const int digit : {sent, unasked, failed, count}) uid += "." + std::to_string(digit);
    return uid;
  }
  std::vector<std::string> warnings() const {
    const std::string study = "study " + uid();
    std::vector<std::string> said;
    if (failed > 0)
      said.push_back(std::to_string(failed) + " of " + std::to_string(sent + failed) + " images of " + study);
    if (unasked > 0) said.push_back("also sent " + std::to_string(unasked) + " objects");
    if (failed == 0 && count > sent) {
      said.push_back("now holds " + std::to_string(count) + " images of " + study + ", and " + std::to_string(sent) +
                     " came");
    }
    return said;
  }
};

/// Of several studies each is counted by itself, in either order.
TEST(OddFetch, OfSeveralIsToldOfEach) {
  std::vector<OfStudy> studies{{2, 0, 0, 2}, {1, 2, 0, 1}, {3, 0, 2, 5}, {1, 0, 0, 2}, {1, 1, 1, 0}, {2, 0, 0, 3}};
  for (const bool backwards : {false, true}) {
    if (backwards) std::ranges::reverse(studies);
    std::vector<std::string> uids, wanted;
    std::size_t files = 0;
    for (const OfStudy& one : studies) {
      uids.push_back(one.uid());
      files += static_cast<std::size_t>(one.sent);
      std::ranges::copy(one.warnings(), std::back_inserter(wanted));
    }
    OddArchive odd("as-its-uid-says");
    const Fetched fetched = fetch(odd.archive(), uids, odd.folder());
    EXPECT_EQ(fetched.files, files);
    ASSERT_EQ(fetched.warnings.size(), wanted.size()) << "with " << uids.front() << " first";
    for (std::size_t n = 0; n < wanted.size(); ++n) {
      EXPECT_THAT(std::string(fetched.warnings[n]), HasSubstr(wanted[n])) << "with " << uids.front() << " first";
    }
  }
}

/// Why nothing came of the last study has nothing to do with what came of those before.
TEST(OddFetch, OfSeveralIsRefusedForWhatCameOfTheLast) {
  for (const auto& [last, why] : {std::pair{OfStudy{0, 0, 0, 2}, "the archive has no images of it"},
                                  {OfStudy{0, 1, 0, 2}, "it sent something else"},
                                  {OfStudy{0, 0, 2, 2}, "all 2 of its images failed"}}) {
    for (const OfStudy& first : {OfStudy{1, 2, 0, 1}, {2, 0, 0, 2}, {1, 0, 3, 4}}) {
      OddArchive odd("as-its-uid-says");
      std::string said = "no refusal";
      try {
        fetch(odd.archive(), {first.uid(), last.uid()}, odd.folder());
      } catch (const ArchiveError& error) {
        said = error.what();
      }
      EXPECT_THAT(said, HasSubstr("study " + last.uid()));
      EXPECT_THAT(said, HasSubstr(why)) << first.uid();
    }
  }
}

/// The sum of all counts; where one is not known, the sum is not.
TEST(OddFetch, OfSeveralExpectsAsManyAsAllTogether) {
  const OfStudy two{2, 0, 0, 2}, four{4, 0, 0, 4}, unknown{3, 0, 0, 0};
  for (const auto& [studies, sum] : {std::pair{std::vector{two, four}, 6},
                                     {{unknown}, -1},
                                     {{unknown, four}, -1},
                                     {{two, unknown}, -1},
                                     {{two, unknown, four}, -1},
                                     {{unknown, unknown}, -1}}) {
    std::vector<std::string> uids;
    for (const OfStudy& one : studies) uids.push_back(one.uid());
    OddArchive odd("as-its-uid-says");
    std::set<int> expected{-1};  // as long as the archive is asked
    fetch(odd.archive(), uids, odd.folder(), {}, [&](const FetchProgress& progress) {
      expected.insert(progress.expected);
      return true;
    });
    EXPECT_EQ(expected, (std::set<int>{-1, sum})) << ::testing::PrintToString(uids);
  }
}

/// Whether a series has grown is asked at the end. All has come by then, whatever is answered.
TEST(OddFetch, ThatDoesNotAnswerAfterwardsTakesNothingBack) {
  for (const char* behavior : {"busy-afterwards", "forgets-afterwards"}) {
    OddArchive odd(behavior);
    const Fetched fetched = fetch(odd.archive(), {"1.2.3"}, odd.folder());
    EXPECT_EQ(fetched.files, 2U) << behavior;
    EXPECT_TRUE(fetched.complete);
    EXPECT_TRUE(fetched.warnings.empty());
  }
}

TEST(OddFetch, ThatIsOutOfResourcesIsQuoted) {
  EXPECT_TRUE(says(OddArchive("out-of-resources").refused_fetch(), "archive {} did not send {}: {}(status A702)"));
}

TEST(OddFetch, ThatDiesMidwayLeavesNothing) {
  EXPECT_TRUE(says(OddArchive("dies-midway").refused_fetch(), "the connection broke after {} images; fetch it again"));
}

TEST(OddFetch, ThatFallsSilentMidwayLeavesNothing) {
  OddArchive odd("falls-silent");
  odd.archive().silence_s = 1;
  EXPECT_TRUE(says(odd.refused_fetch(), "the connection broke after {} images; fetch it again"));
}

TEST(OddFetch, ThatSendsAByteAWhileIsGivenUp) {
  const auto begin = std::chrono::steady_clock::now();
  OddArchive odd("drips");
  odd.archive().silence_s = 1;
  EXPECT_TRUE(says(odd.refused_fetch(), "the connection broke after {} images; fetch it again"));
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(8));
}

TEST(OddFetch, ThatSendsWithoutEndIsBounded) {
  FetchLimits limits;
  limits.bytes = 64U << 20U;
  EXPECT_EQ(OddArchive("without-end").refused_fetch(limits),
            "more than 64 MiB came: fetch series by series, or allow more with --most-mib");
}

}  // namespace
}  // namespace palpate::io
