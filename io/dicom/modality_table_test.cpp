// Modality look-up tables (PS3.3 C.11.1): their first value, signed or not, and invalid ones; and the identity of a
// scan.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcuid.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

struct TableOfWords {
  int count = 8, first = 0, bits = 16;
  std::vector<Uint16> words;
};

void put_table(DcmDataset& dataset, const TableOfWords& table) {
  DcmItem& item = group(dataset, DCM_ModalityLUTSequence);
  const std::vector<Uint16> descriptor{static_cast<Uint16>(table.count), static_cast<Uint16>(table.first),
                                       static_cast<Uint16>(table.bits)};
  succeed(item.putAndInsertUint16Array(DcmTag(DCM_LUTDescriptor, EVR_US), descriptor.data(), 3));
  succeed(item.putAndInsertUint16Array(DcmTag(DCM_LUTData, EVR_OW), table.words.data(),
                                       static_cast<unsigned long>(table.words.size())));
  succeed(item.putAndInsertString(DCM_ModalityLUTType, "US"));
}

// Of signed pixels 65533 is -3, and 2 is 2; of others 65533 is what it says.
TEST(ModalityTables, BeginWhereTheirPixelsSignSays) {
  struct Case {
    bool is_signed;
    int first;
  };
  for (const Case& one :
       {Case{true, -3}, {true, 2}, {true, 32000}, {true, -32768}, {false, 2}, {false, 40000}, {false, 65000}}) {
    const TestFolder folder;
    const std::vector<Uint16> words{5, 50, 15, 150, 25, 250, 35, 350};
    write_stack(folder.path(), 2, [&](int, TestImage& image) {
      image.value = [&](int i, int j) { return one.first + i + j % 2; };
      image.edit = [&](DcmDataset& d) {
        put(d, DCM_PixelRepresentation, one.is_signed ? 1 : 0);
        put_table(d, {8, one.first, 16, words});
      };
    });
    const Volume volume = load(only_series_in(folder));
    for (int j = 0; j < 4; ++j) {
      for (int i = 0; i < 6; ++i) {
        EXPECT_EQ(volume.value_at(i, j, 1), words[static_cast<std::size_t>(i + j % 2)]) << one.is_signed << one.first;
      }
    }
  }
}

std::string refusal_of_table(const TableOfWords& table) {
  const TestFolder folder;
  write_stack(folder.path(), 2,
              [&](int, TestImage& image) { image.edit = [&](DcmDataset& d) { put_table(d, table); }; });
  const Catalogue found = find_in(folder);
  return found.skipped.empty() ? "none" : std::string(found.skipped.front().reason);
}

// As many words as it says, or as many bytes where its entries have 8 bits.
TEST(ModalityTables, ThatEndEarlyAreDamaged) {
  const std::string damaged = refusal_of_table({8, 0, 16, std::vector<Uint16>(7, 1)});
  EXPECT_NE(damaged.find("look-up table"), std::string::npos) << damaged;
  EXPECT_EQ(refusal_of_table({8, 0, 16, std::vector<Uint16>(8, 1)}), "none");
  EXPECT_EQ(refusal_of_table({8, 0, 16, std::vector<Uint16>(9, 1)}), "none");
  EXPECT_EQ(refusal_of_table({8, 0, 16, std::vector<Uint16>(4, 1)}), damaged);
  EXPECT_EQ(refusal_of_table({8, 0, 8, std::vector<Uint16>(4, 1)}), "none");
  EXPECT_EQ(refusal_of_table({8, 0, 8, std::vector<Uint16>(3, 1)}), damaged);
  EXPECT_EQ(refusal_of_table({8, 0, 9, std::vector<Uint16>(4, 1)}), damaged);
  const TestFolder folder;
  write_stack(folder.path(), 2,
              [](int, TestImage& image) { image.edit = [](DcmDataset& d) { group(d, DCM_ModalityLUTSequence); }; });
  EXPECT_EQ(find_in(folder).skipped.at(0).reason, damaged) << "without a descriptor";
}

TEST(LoadedScan, IsOfItsPatient) {
  const TestFolder folder;
  write_stack(folder.path(), 3, [](int, TestImage& image) {
    image.edit = [](DcmDataset& d) {
      put(d, DCM_SpecificCharacterSet, std::string("ISO_IR 100"));
      put(d, DCM_PatientName, std::string("M\xFCller^Zo\xEB"));
      put(d, DCM_PatientID, std::string("47\xE4"));
      put(d, DCM_StudyDate, std::string("20240229"));
      put(d, DCM_FrameOfReferenceUID, std::string("1.2.3.9"));
      put(d, DCM_Modality, std::string("MR"));
    };
  });
  const Series series = only_series_in(folder);
  EXPECT_EQ(series.identity.patient_name, "M\xC3\xBCller^Zo\xC3\xAB");
  EXPECT_EQ(series.identity.patient_id, "47\xC3\xA4");
  EXPECT_EQ(series.identity.study_date, "20240229");
  const Volume volume = load(series);
  EXPECT_EQ(volume.patient_name, series.identity.patient_name);
  EXPECT_EQ(volume.patient_id, series.identity.patient_id);
  EXPECT_EQ(volume.frame_of_reference_uid, "1.2.3.9");
  EXPECT_EQ(volume.modality, "MR");
}

}  // namespace
}  // namespace palpate::io::internal
