#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdict.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <array>
#include <fstream>

#include "io/dicom/dcmtk_start.h"
#include "io/errors.h"
#include "io/files_below.h"
#include "io/load.h"
#include "io/series.h"
#include "io/structures/structure.h"
#include "io/testing/comma_locale.h"
#include "io/testing/test_image.h"
#include "io/testing/working_folder.h"

namespace palpate::io::internal {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

TEST(FindFiles, DescriptionBecomesUtf8) {
  const std::array<std::array<std::string, 3>, 7> cases{
      {{"ISO_IR 100", "T\xEAte", "T\xC3\xAAte"},
       {"ISO_IR 192", "\xE9\xA0\xAD", "\xE9\xA0\xAD"},
       {"ISO_IR 144", "\xB3\xDE\xDB\xDE\xD2\xD0", "Голова"},
       {"\\ISO 2022 IR 87", "\x1B$B;3ED\x1B(B^\x1B$BB@O:\x1B(B", "山田^太郎"},
       {"ISO 2022 IR 13\\ISO 2022 IR 87", "\xD4\xCF\xC0\xDE=\x1B$B;3ED\x1B(J", "ﾔﾏﾀﾞ=山田"},
       {"GB18030", "\xCD\xF5\xD0\xA1\xB6\xAB", "王小东"},
       {"", "T\xEAte", "T\xC3\xAAte"}}};
  for (const auto& texts : cases) {  // character set, as stored, expected
    const TestFolder folder;
    write_stack(folder.path(), 2, [&](int, TestImage& image) {
      image.edit = [&](DcmDataset& d) {
        if (!texts[0].empty()) put(d, DCM_SpecificCharacterSet, texts[0]);
        put(d, DCM_SeriesDescription, texts[1]);
        put(d, DCM_PatientName, texts[1]);
      };
    });
    const Series series = find_in(folder).series.at(0);
    EXPECT_EQ(series.description, texts[2]) << texts[0];
    EXPECT_EQ(series.identity.patient_name, texts[2]) << texts[0];
  }
}

// A host program may run in a country that writes 0,75: neither attributes nor words may change.
TEST(FindFiles, DecimalCommaOfTheLocaleChangesNothing) {
  const TestFolder folder;
  write_stack(folder.path(), 6, [](int k, TestImage& image) {
    image.z = k == 5 ? 13.75 : 2.25 * k;
    image.edit = [](DcmDataset& d) { put(d, DCM_RescaleIntercept, "-0.5"); };
  });
  const Series before = find_in(folder).series.at(0);
  Series after;
  {
    const CommaLocale comma;
    if (!comma.is_set()) GTEST_SKIP() << CommaLocale::needed;
    after = find_in(folder).series.at(0);
  }
  EXPECT_EQ(after.geometry.spacing_i, 0.75);
  EXPECT_EQ(after.geometry.slice_positions, before.geometry.slice_positions);
  ASSERT_THAT(before.warnings, SizeIs(1));
  EXPECT_EQ(after.warnings, before.warnings);
}

TEST(FindFiles, DicomdirStandsForItsFolder) {
  const TestFolder folder;
  write_stack(folder.path(), 3);
  std::ofstream(folder / "DICOMDIR") << "whatever it says";
  EXPECT_EQ(find_series(std::array{folder / "DICOMDIR"}).series.at(0).geometry.dimensions.z, 3);
}

// As it is named in the folder of a CD.
TEST(FindFiles, DicomdirStandsForItsFolderByItsNameAlone) {
  for (const char* const name : {"DICOMDIR", "dicomdir"}) {
    const TestFolder folder;
    std::filesystem::create_directory(folder / "below");
    write_stack(folder / "below", 3);
    std::ofstream(folder / name) << "whatever it says";
    const auto found_as = [](const std::filesystem::path& named) {
      const Catalogue found = find_series(std::array{named});
      return found.series.empty() ? 0 : found.series[0].geometry.dimensions.z;
    };
    {
      const testing::WorkingFolder here(folder.path());
      EXPECT_EQ(found_as(name), 3) << name;
      EXPECT_EQ(found_as(std::filesystem::path(".") / name), 3) << name;
    }
    const testing::WorkingFolder below(folder / "below");
    EXPECT_EQ(found_as(std::filesystem::path("..") / name), 3) << name;
  }
}

TEST(FindFiles, CancelledHalfWayLeavesNothingRunning) {
  const TestFolder folder;
  write_stack(folder.path(), 40);
  const Series series = find_in(folder).series.at(0);
  for (const double stop_at : {0.0, 0.2, 0.9}) {
    LoadOptions options;
    int later = 0;
    bool stopped = false;
    options.progress = [&](double done) {
      later += stopped;
      stopped = stopped || done >= stop_at;
      return !stopped;
    };
    EXPECT_THROW(load(series, options), Cancelled);
    EXPECT_EQ(later, 0) << "called again after it said no";
  }
}

TEST(FindFiles, MissingDataDictionaryIsRefusedByName) {
  EXPECT_NO_THROW(start_dcmtk());
  DcmDataDictionary empty(OFFalse, OFFalse);
  empty.clear();
  for (const bool loaded : {false, true}) {
    try {
      check_dictionary(empty, loaded);
      FAIL();
    } catch (const DicomError& error) {
      EXPECT_THAT(error.what(), HasSubstr("DCMDICTPATH"));
    }
  }
}

TEST(FindFiles, NamesWhatDoesNotExist) {
  const TestFolder folder;
  try {
    find_series(std::array{folder / "absent"});
    FAIL();
  } catch (const DicomError& error) {
    EXPECT_THAT(error.what(), HasSubstr("absent"));
  }
}

TEST(FindFiles, CanBeCancelledAndReportsProgress) {
  const TestFolder folder;
  write_stack(folder.path(), 8);
  EXPECT_THROW(find_series(std::array{folder.path()}, [](double) { return false; }), Cancelled);
  std::vector<double> reported;
  const Catalogue found = find_series(std::array{folder.path()}, [&](double done) {
    reported.push_back(done);
    return true;
  });
  EXPECT_TRUE(std::is_sorted(reported.begin(), reported.end()));
  LoadOptions options;
  options.progress = [](double) { return false; };
  EXPECT_THROW(load(found.series.at(0), options), Cancelled);
}

/// Listing "/" takes minutes.
TEST(FindFiles, TheListingOfAFolderCanBeCancelled) {
  const TestFolder folder;
  std::filesystem::create_directory(folder / "below");
  for (const char* const name : {"a", "b", "below/c"}) std::ofstream(folder / name);
  const std::array paths{folder.path()};
  std::vector<SkippedFile> skipped;
  int asked = 0;
  EXPECT_THROW(files_below(paths, skipped, [&](double) { return ++asked < 3; }), Cancelled);
  EXPECT_EQ(asked, 3);
  int at_the_start = 0;
  const auto count = [&](double done) {
    at_the_start += done == 0 ? 1 : 0;
    return true;
  };
  find_series(paths, count);
  EXPECT_GE(at_the_start, 4) << "each entry";
  at_the_start = 0;
  find_structures(paths, count);
  EXPECT_GE(at_the_start, 4);
}

TEST(FindFiles, EveryFileOfAForeignFolderIsNamed) {
  const TestFolder folder;
  std::ofstream(folder / "empty");
  std::ofstream(folder / "text.dcm") << "ISO_IR looks like nothing";
  std::ofstream(folder / "short") << "DICM";
  const Catalogue found = find_in(folder);
  EXPECT_THAT(found.series, IsEmpty());
  EXPECT_THAT(found.skipped, SizeIs(3));
}

TEST(FindFiles, FolderBelowThatMayNotBeReadIsNamed) {
  const TestFolder folder;
  write_stack(folder.path(), 3);
  std::filesystem::create_directory(folder / "locked");
  std::filesystem::permissions(folder.path(), std::filesystem::perms(0755));
  for (const auto& entry : std::filesystem::directory_iterator(folder.path())) {
    if (entry.is_regular_file()) std::filesystem::permissions(entry.path(), std::filesystem::perms(0644));
  }
  std::filesystem::permissions(folder / "locked", std::filesystem::perms::none);
  constexpr uid_t nobody = 65534;
  const bool is_root = ::geteuid() == 0;
  if (is_root) {  // who may read all
    std::filesystem::permissions(folder.path().parent_path(),
                                 std::filesystem::perms::group_exec | std::filesystem::perms::others_exec,
                                 std::filesystem::perm_options::add);
    ASSERT_EQ(::seteuid(nobody), 0);
  }
  const Catalogue found = find_in(folder);
  if (is_root) {
    ASSERT_EQ(::seteuid(0), 0);
  }
  std::filesystem::permissions(folder / "locked", std::filesystem::perms::owner_all);
  EXPECT_THAT(found.series, SizeIs(1));
  ASSERT_THAT(found.skipped, SizeIs(1));
  EXPECT_EQ(found.skipped[0].path.filename(), "locked");
  EXPECT_EQ(found.skipped[0].reason, "a folder that may not be read: ask for the right to it");
}

}  // namespace
}  // namespace palpate::io::internal
