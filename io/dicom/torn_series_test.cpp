// Series that a reader may split wrongly, or join over missing parts: jittering digits, a patient named only in some
// files, time points that lack slices.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <set>
#include <string>
#include <vector>

#include "io/fields/volume_fields.h"
#include "io/load.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

using ::testing::SizeIs;

TEST(TornSeries, PixelSpacingsThatDifferInTheirLastDigitsAreOneSeries) {
  for (const double jitter : {1e-7, 1e-5, 9e-5, 2e-4, 4e-4}) {
    for (const bool of_rows : {false, true}) {
      const TestFolder folder;
      write_stack(folder.path(), 9, [&](int k, TestImage& image) {
        const std::string other = std::to_string(0.7 * (1 + jitter * (k % 3 - 1)));
        image.edit = [=](DcmDataset& d) { put(d, DCM_PixelSpacing, of_rows ? other + "\\0.7" : "0.7\\" + other); };
      });
      const Catalogue found = find_in(folder);
      ASSERT_THAT(found.series, SizeIs(1)) << jitter;
      EXPECT_EQ(found.series[0].geometry.dimensions.z, 9) << jitter;
    }
  }
}

/// Of twelve slices those that `named` names have the patient's id.
Catalogue with_ids(
    const std::function<std::string(int)>& id_of,
    const std::function<std::string(int)>& name_of = [](int) { return "Doe^Jane"; }) {
  const TestFolder folder;
  write_stack(folder.path(), 12, [&](int k, TestImage& image) {
    image.edit = [&, k](DcmDataset& d) {
      put(d, DCM_PatientID, id_of(k));
      put(d, DCM_PatientName, name_of(k));
    };
  });
  return find_in(folder);
}

TEST(TornSeries, APatientsIdThatIsBlankInSomeFilesIsThatOfTheOthers) {
  const std::vector<std::function<bool(int)>> blanks{[](int k) { return k % 2 == 0; }, [](int k) { return k < 6; },
                                                     [](int k) { return k > 0; }, [](int k) { return k == 11; }};
  for (std::size_t n = 0; n < blanks.size(); ++n) {
    for (const bool names_too : {false, true}) {
      const Catalogue found = with_ids([&](int k) { return blanks[n](k) ? "" : "id 7"; },
                                       [&](int k) { return names_too && blanks[n](k) ? "" : "Doe^Jane"; });
      ASSERT_THAT(found.series, SizeIs(1)) << n;
      EXPECT_EQ(found.series[0].geometry.dimensions.z, 12);
      EXPECT_EQ(found.series[0].identity.patient_id, "id 7") << "whichever file comes first";
      EXPECT_EQ(found.series[0].identity.patient_name, "Doe^Jane");
    }
  }
}

// Both at once: the blanks are filled in before the frames of reference are compared.
TEST(TornSeries, AStackThatLostIdsAndFramesOfReferenceIsOne) {
  const std::vector<std::function<bool(int)>> blanks{[](int k) { return k % 2 == 0; }, [](int k) { return k < 6; },
                                                     [](int k) { return k > 0; }, [](int k) { return k == 11; }};
  for (std::size_t n = 0; n < blanks.size(); ++n) {
    const TestFolder folder;
    write_stack(folder.path(), 12, [&](int k, TestImage& image) {
      image.edit = [&, k](DcmDataset& d) {
        put(d, DCM_PatientID, blanks[n](k) ? "" : "id 7");
        put(d, DCM_FrameOfReferenceUID, numbered("1.2.77.", k));
      };
    });
    const Catalogue found = find_in(folder);
    ASSERT_THAT(found.series, SizeIs(1)) << n;
    EXPECT_TRUE(found.series[0].usable) << n;
    EXPECT_EQ(found.series[0].geometry.dimensions.z, 12) << n;
    EXPECT_EQ(found.series[0].identity.patient_id, "id 7") << n;
  }
}

TEST(TornSeries, PatientsOfDifferentIdsOrNamesAreNeverMixed) {
  EXPECT_THAT(with_ids([](int k) { return k % 2 == 0 ? "id 7" : "id 8"; }).series, SizeIs(2));
  EXPECT_THAT(with_ids([](int k) { return k % 3 == 0 ? "" : k % 3 == 1 ? "id 7" : "id 8"; }).series, SizeIs(3));
  EXPECT_THAT(with_ids([](int k) { return k % 2 == 0 ? "id 7" : ""; },
                       [](int k) { return k % 2 == 0 ? "Doe^Jane" : "Roe^Ann"; })
                  .series,
              SizeIs(2));
}

constexpr int bold_slices = 20, bold_times = 5;

// What one time alone has is missing in no other.
TEST(TornSeries, ASliceOfOneTimeAloneIsMissedInNoOther) {
  const TestFolder folder;
  for (int time = 0; time < bold_times; ++time) {
    for (int half = 0; half < 2 * bold_slices; ++half) {
      if (half % 2 == 1 && (time != 1 || half != 7)) continue;
      TestImage image;
      image.z = 2.0 * half;
      image.edit = [=](DcmDataset& d) {
        put(d, DCM_Modality, "MR");
        put(d, DCM_SliceThickness, std::string("4"));
        put(d, DCM_TemporalPositionIdentifier, std::to_string(time + 1));
      };
      write(image, folder / (std::to_string(time) + "_" + std::to_string(half)));
    }
  }
  const Series series = only_series_in(folder);
  ASSERT_EQ(series.frames_per_position, bold_times);
  for (const int time : {0, 2, 3, 4}) {
    const Volume volume = load_frame(series, time);
    EXPECT_EQ(volume.geometry.dimensions.z, bold_slices) << time;
    EXPECT_TRUE(volume.geometry.gaps.empty()) << time;
  }
}

// What one time lacks and the others have is missing there: nothing is felt between its neighbors, as in a stack that
// lacks slices.
TEST(TornSeries, ATimeThatLacksSlicesIsNotFeltWhereTheyAre) {
  const std::vector<std::set<int>> all_lacking{{3}, {3, 4}, {9, 10, 11}, {3, 5, 7, 9, 11}, {0, 7}, {18, 19}};
  for (const auto& lacking : all_lacking) {
    for (const int poor : {0, 2, bold_times - 1}) {
      const TestFolder folder;
      for (int time = 0; time < bold_times; ++time) {
        for (int k = 0; k < bold_slices; ++k) {
          if (time == poor && lacking.contains(k)) continue;
          TestImage image;
          image.z = 4.0 * k;
          image.value = [=](int, int) { return 1000 * time + 10 * k; };
          image.edit = [=](DcmDataset& d) {
            put(d, DCM_Modality, "MR");
            put(d, DCM_SliceThickness, std::string("4"));
            put(d, DCM_TemporalPositionIdentifier, std::to_string(time + 1));
          };
          write(image, folder / (std::to_string(time) + "_" + std::to_string(k)));
        }
      }
      const Series series = only_series_in(folder);
      ASSERT_EQ(series.frames_per_position, bold_times);
      for (int time = 0; time < bold_times; ++time) {
        const auto volume = std::make_shared<const Volume>(load_frame(series, time));
        const VolumeFields fields(volume, FieldSet::value, 1, {.value = ValueMethod::trilinear});
        std::set<int> present;
        for (int k = 0; k < bold_slices; ++k) {
          if (time != poor || !lacking.contains(k)) present.insert(k);
        }
        for (int k = *present.begin(); k < *present.rbegin(); ++k) {
          const bool is_there = present.contains(k) && present.contains(k + 1);
          const Sample sample = fields.sample({1.5, 1, 4.0 * k + 2}, FieldSet::value);
          EXPECT_EQ(sample.inside, is_there) << "time " << time << ", above slice " << k;
          const double between = 1000 * time + 10 * k + 5;
          EXPECT_NEAR(sample.inside ? sample.value : between, between, 1e-3);
        }
      }
    }
  }
}

}  // namespace
}  // namespace palpate::io::internal
