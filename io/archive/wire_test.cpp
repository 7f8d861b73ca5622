// Our messages on the wire against the standard: an archive that speaks DICOM byte by byte
// (testing/odd_archive_main.cpp) prints its requests and how the association ends.

#include <gtest/gtest.h>

#include <filesystem>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "io/archive/archive.h"
#include "io/archive/fetch.h"
#include "io/archive/find.h"
#include "io/archive/send.h"
#include "io/archive/testing/made_series.h"
#include "io/archive/testing/odd_archive.h"
#include "io/errors.h"

namespace palpate::io {
namespace {

using testing::OddArchive;
using Lines = std::vector<std::string>;

// DICOM PS3.6 annex A.
const std::string verification = "1.2.840.10008.1.1";
const std::string find_model = "1.2.840.10008.5.1.4.1.2.2.1";
const std::string move_model = "1.2.840.10008.5.1.4.1.2.2.2";
const std::string get_model = "1.2.840.10008.5.1.4.1.2.2.3";
const std::string storage = "1.2.840.10008.5.1.4.1.1.";
const std::string uncompressed = " 1.2.840.10008.1.2.1 1.2.840.10008.1.2";

/// What it tells of its next association, to the end of it: by release (5) or by abort (7), PS3.8 9.3.1.
Lines next_association(OddArchive& odd) {
  Lines lines;
  do {
    lines.push_back(odd.process().read_line());
  } while (!lines.back().empty() && !lines.back().starts_with("ended by"));
  return lines;
}

TEST(OnTheWire, AnEchoIsOneQuestion) {
  OddArchive odd("tells");
  echo(odd.archive());
  EXPECT_EQ(next_association(odd), (Lines{"PALPATE calls ODD", "context 1 " + verification + uncompressed,
                                          "command 0030 id 1 class " + verification, "ended by 5"}));
}

/// PS3.4 C.6.2: the keys of each level, and with them what is asked for. Each question has a number of its own.
TEST(OnTheWire, AQuestionHasTheKeysOfItsLevel) {
  OddArchive odd("tells");
  const Found found = find(
      odd.archive(),
      {.patient = "M\xC3\xBCller", .patient_id = "P1", .date = "20200103-", .modality = "MR", .description = "Head*"});
  EXPECT_EQ(next_association(odd), (Lines{"PALPATE calls ODD",
                                          "context 1 " + find_model + uncompressed,
                                          "command 0020 id 1 priority 0 class " + find_model,
                                          "key 00080005 ISO_IR 192",
                                          "key 00080020 20200103-",
                                          "key 00080052 STUDY",
                                          "key 00080061 MR",
                                          "key 00081030 Head*",
                                          "key 00100010 *M\xC3\xBCller*",
                                          "key 00100020 P1",
                                          "key 0020000D ",
                                          "command 0020 id 2 priority 0 class " + find_model,
                                          "key 00080052 SERIES",
                                          "key 00080060 MR",
                                          "key 0008103E ",
                                          "key 0020000D 1.2.3",
                                          "key 0020000E ",
                                          "key 00200011 ",
                                          "key 00201209 ",
                                          "command 0020 id 3 priority 0 class " + find_model,
                                          "key 00080018 ",
                                          "key 00080052 IMAGE",
                                          "key 0020000D 1.2.3",
                                          "key 0020000E 1.2.3.1",
                                          "ended by 5"}));
  ASSERT_EQ(found.studies.size(), 1U);
  ASSERT_EQ(found.studies.front().series.size(), 1U);
  EXPECT_EQ(found.studies.front().series.front().uid, "1.2.3.1");
  EXPECT_EQ(found.studies.front().series.front().images, 1) << "counted, since it does not say";
}

/// A part of a text is asked for with the archive's wildcards, but for one that has its own; a text beyond ASCII alone
/// needs its character set.
TEST(OnTheWire, WordsAreAskedForAsTheyAre) {
  const auto keys_of = [](const ArchiveQuery& query) {
    OddArchive odd("tells");
    find(odd.archive(), query);
    std::map<std::string, std::string> keys;
    for (const std::string& line : next_association(odd)) {
      if (line.starts_with("key ") && !keys.contains(line.substr(4, 8))) keys[line.substr(4, 8)] = line.substr(13);
    }
    return keys;
  };
  ArchiveQuery query;
  query.with_series = false;
  auto keys = keys_of(query);
  EXPECT_FALSE(keys.contains("00080005"));
  EXPECT_EQ(keys["00100010"], "");
  EXPECT_EQ(keys["00081030"], "");
  query.patient = "a?c";
  query.description = "d";
  keys = keys_of(query);
  EXPECT_FALSE(keys.contains("00080005"));
  EXPECT_EQ(keys["00100010"], "a?c");
  EXPECT_EQ(keys["00081030"], "*d*");
  for (std::string ArchiveQuery::*const text :
       {&ArchiveQuery::patient, &ArchiveQuery::patient_id, &ArchiveQuery::description}) {
    query = {.with_series = false};
    query.*text = "\xC3\xBC";
    EXPECT_EQ(keys_of(query)["00080005"], "ISO_IR 192");
  }
}

TEST(OnTheWire, AUidIsLookedForAmongStudiesAndThenAmongSeries) {
  OddArchive odd("tells-of-series");
  const Wanted wanted = find_uid(odd.archive(), "1.2.3.1");
  EXPECT_EQ(next_association(odd),
            (Lines{"PALPATE calls ODD", "context 1 " + find_model + uncompressed,
                   "command 0020 id 1 priority 0 class " + find_model, "key 00080052 STUDY", "key 0020000D 1.2.3.1",
                   "key 00201208 ", "command 0020 id 2 priority 0 class " + find_model, "key 00080052 SERIES",
                   "key 0020000D ", "key 0020000E 1.2.3.1", "key 00201209 ", "ended by 5"}));
  EXPECT_EQ(wanted.study_uid, "1.2.3");
  EXPECT_EQ(wanted.series_uid, "1.2.3.1");
  EXPECT_EQ(wanted.images, -1) << "it does not say";
  OddArchive of_study("tells");
  const Wanted study = find_uid(of_study.archive(), "1.2.3");
  EXPECT_EQ(study.study_uid, "1.2.3");
  EXPECT_EQ(study.series_uid, "");
  EXPECT_EQ(study.images, 2);
}

/// All that can be read may come: uncompressed and in each encoding that is read, on odd contexts (PS3.8 9.3.2.2).
TEST(OnTheWire, AGetOffersToReceiveAllThatIsRead) {
  OddArchive odd("tells");
  fetch(odd.archive(), {"1.2.3"}, odd.folder());
  next_association(odd);
  const Lines lines = next_association(odd);
  std::multiset<std::string> offered, expected{get_model + uncompressed};
  std::size_t at = 1;
  for (; at < lines.size() && lines[at].starts_with("context "); ++at) {
    const std::string number = std::to_string(2 * at - 1);
    EXPECT_TRUE(lines[at].starts_with("context " + number + " ")) << lines[at];
    offered.insert(lines[at].substr(9 + number.size()));
  }
  // CT, MR, enhanced CT, enhanced MR and PET images.
  for (const char* const kind : {"2", "4", "2.1", "4.1", "128"}) {
    expected.insert(storage + kind + " receives" + uncompressed);
    // JPEG lossless, 12 and 8 bit, progressive and by spectral selection; JPEG 2000, JPEG-LS, RLE; deflated, big
    // endian.
    for (const char* const syntax :
         {"4.70", "4.57", "4.51", "4.50", "4.55", "4.53", "4.90", "4.91", "4.80", "4.81", "5", "1.99", "2"}) {
      expected.insert(storage + kind + " receives 1.2.840.10008.1.2." + syntax);
    }
  }
  // SEG, RTSTRUCT, legacy converted CT, MR and PET, enhanced PET, secondary capture, 3D X-ray; basic, enhanced,
  // comprehensive and 3D SR; parametric map, registration, surface SEG, US, NM, RT dose, radiation dose SR.
  for (const char* const kind : {"66.4", "481.3", "2.2", "4.4", "128.1", "130", "7", "13.1.1", "88.11", "88.22",
                                 "88.33", "88.34", "30", "66.1", "66.5", "6.1", "20", "481.2", "88.67"}) {
    expected.insert(storage + kind + " receives" + uncompressed);
  }
  EXPECT_EQ(offered, expected);
  EXPECT_EQ(Lines(lines.begin() + static_cast<std::ptrdiff_t>(at), lines.end()),
            (Lines{"command 0010 id 1 priority 0 class " + get_model, "key 00080052 STUDY", "key 0020000D 1.2.3",
                   "stored 0000 to 77 of " + storage + "2 1.2.3.4", "stored 0000 to 77 of " + storage + "2 1.2.3.4",
                   "stored 0000 to 77 of " + storage + "2 1.2.3.5", "ended by 5"}));
}

/// And the storage service answers what it is sent by its number (PS3.7 9.1.1, 9.1.5), and a release with a release.
TEST(OnTheWire, AMoveNamesUsAndIsAnswered) {
  for (const bool asks : {false, true}) {
    OddArchive odd(asks ? "tells-and-asks" : "tells-all");
    odd.archive().uses_get = false;
    const Fetched fetched = fetch(odd.archive(), {"1.2.3"}, odd.folder());
    EXPECT_EQ(fetched.files, 1U);
    next_association(odd);
    EXPECT_EQ(next_association(odd),
              (Lines{"PALPATE calls ODD", "context 1 " + move_model + uncompressed,
                     "command 0021 id 1 priority 0 class " + move_model + " destination PALPATE", "key 00080052 STUDY",
                     "key 0020000D 1.2.3", "command 8030 to 5 status 0 class " + verification,
                     "command 8001 to 77 status 0 class " + storage + "2 object 1.2.3.4",
                     asks ? "ends with 7" : "ends with 6", "ended by 5"}));
  }
}

TEST(OnTheWire, AMoveOfASeriesAsksForItAlone) {
  OddArchive odd("tells-of-series");
  odd.archive().uses_get = false;
  EXPECT_THROW(fetch(odd.archive(), {"1.2.3.1"}, odd.folder()), ArchiveError);
  next_association(odd);
  EXPECT_EQ(next_association(odd),
            (Lines{"PALPATE calls ODD", "context 1 " + move_model + uncompressed,
                   "command 0021 id 1 priority 0 class " + move_model + " destination PALPATE", "key 00080052 SERIES",
                   "key 0020000D 1.2.3", "key 0020000E 1.2.3.1", "ended by 5"}));
}

/// Each file in a context of its class, by a number of its own.
TEST(OnTheWire, EachFileThatIsSentIsNamed) {
  OddArchive odd("tells");
  std::vector<std::filesystem::path> files;
  for (const std::string& name : {testing::ct, testing::compressed}) {
    files.push_back(std::filesystem::directory_iterator(testing::made_series() / name)->path());
  }
  std::vector<std::size_t> told;
  EXPECT_EQ(send(odd.archive(), files,
                 [&](std::size_t done) {
                   if (told.empty() || told.back() != done) told.push_back(done);
                   return true;
                 })
                .files,
            2U);
  EXPECT_EQ(told, (std::vector<std::size_t>{0, 1}));
  const Lines lines = next_association(odd);
  ASSERT_EQ(lines.size(), 6U);
  EXPECT_EQ(lines[1], "context 1 " + storage + "2" + uncompressed);
  EXPECT_EQ(lines[2], "context 3 " + storage + "4 1.2.840.10008.1.2.4.70");
  EXPECT_TRUE(lines[3].starts_with("command 0001 id 1 priority 0 class " + storage + "2 object 1.2.826.")) << lines[3];
  EXPECT_TRUE(lines[4].starts_with("command 0001 id 2 priority 0 class " + storage + "4 object 1.2.826.")) << lines[4];
  EXPECT_EQ(lines[5], "ended by 5");
}

/// Only what went well is released.
TEST(OnTheWire, WhatFailedIsAborted) {
  for (const char* const behavior : {"tells-and-errs", "tells-of-other"}) {
    OddArchive odd(behavior);
    EXPECT_THROW(find(odd.archive(), {}), ArchiveError);
    EXPECT_EQ(next_association(odd).back(), "ended by 7") << behavior;
  }
  OddArchive odd("tells-late");
  EXPECT_THROW(find(odd.archive(), {}, [] { return false; }), Cancelled);
  EXPECT_EQ(next_association(odd).back(), "ended by 7");
}

}  // namespace
}  // namespace palpate::io
