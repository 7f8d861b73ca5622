// Which parts of a header DCMTK parses, and which the reader uses.
#include "io/dicom/asked_for.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gtest/gtest.h>

#include <array>
#include <stdexcept>

#include "io/dicom/dicom_value.h"
#include "io/load.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

Volume load_only(const TestFolder& folder) {
  const Catalogue found = find_series(std::array{folder.path()});
  EXPECT_TRUE(found.skipped.empty());
  return load(found.series.at(0));
}

// Private elements and sequences, and groups that no image needs, in front of, between and behind what is read.
void add_what_nobody_asks_for(DcmDataset& d) {
  succeed(d.putAndInsertString(DcmTag(0x0009, 0x0010, EVR_LO), "SOMEBODY"));
  succeed(d.putAndInsertString(DcmTag(0x0009, 0x1001, EVR_LO), "secret"));
  DcmItem* item = nullptr;
  succeed(d.findOrCreateSequenceItem(DcmTag(0x0019, 0x1002, EVR_SQ), item, -2));
  succeed(item->putAndInsertString(DCM_RescaleSlope, "77"));  // of something else
  succeed(d.findOrCreateSequenceItem(DCM_ReferencedImageSequence, item, -2));
  succeed(item->putAndInsertString(DCM_ImagePositionPatient, "9\\9\\9"));
  succeed(d.putAndInsertString(DCM_InstitutionName, "a hospital"));
  succeed(d.putAndInsertString(DcmTag(0x5001, 0x1000, EVR_LT), std::string(30000, 'x').c_str()));
}

TEST(AskedFor, WhatNobodyAsksForChangesNothing) {
  for (const E_TransferSyntax syntax : {EXS_LittleEndianExplicit, EXS_LittleEndianImplicit, EXS_BigEndianExplicit}) {
    const TestFolder plain;
    const TestFolder heavy;
    write_stack(plain.path(), 4, [&](int, TestImage& image) { image.syntax = syntax; });
    write_stack(heavy.path(), 4, [&](int, TestImage& image) {
      image.syntax = syntax;
      image.edit = add_what_nobody_asks_for;
    });
    const Volume a = load_only(plain);
    const Volume b = load_only(heavy);
    EXPECT_EQ(a.voxels, b.voxels);
    EXPECT_EQ(a.slope, b.slope);
    EXPECT_EQ(a.geometry.slice_positions, b.geometry.slice_positions);
    EXPECT_EQ(a.geometry.spacing_i, b.geometry.spacing_i);
  }
}

// DCMTK's findAndGetFloat64 makes a slope of 0 out of one that is not there.
TEST(AskedFor, WithoutARescaleValuesAreThoseStored) {
  const TestFolder folder;
  write_stack(folder.path(), 3);  // which has none
  const Volume volume = load_only(folder);
  EXPECT_EQ(volume.slope, 1);
  EXPECT_EQ(volume.intercept, 0);
  EXPECT_EQ(volume.value_at(3, 2, 1), 132);
}

TEST(AskedFor, ToAskForMoreIsAFaultOfTheProgram) {
  DcmDataset dataset;
  succeed(dataset.putAndInsertString(DCM_InstitutionName, "a hospital"));
  EXPECT_THROW(text_of(dataset, DCM_InstitutionName), std::logic_error);
  EXPECT_THROW(numbers_of(dataset, DCM_KVP), std::logic_error);
  EXPECT_THROW(first_item(dataset, DCM_ReferencedImageSequence), std::logic_error);
  EXPECT_EQ(text_of(dataset, DCM_Modality), "");
}

}  // namespace
}  // namespace palpate::io::internal
