// What a file says of one of its structures, and not of another one.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "io/structures/label_image.h"
#include "io/structures/structure.h"
#include "io/testing/test_image.h"

namespace palpate::io {
namespace {

using internal::succeed;
using internal::TestFolder;
using internal::TestImage;

DcmItem& listed_item(DcmItem& item, const DcmTagKey& sequence) {
  DcmItem* added = nullptr;
  succeed(item.findOrCreateSequenceItem(sequence, added, -2));
  return *added;
}

void add_code(DcmItem& item, const DcmTagKey& sequence, const std::string& value) {
  succeed(listed_item(item, sequence).putAndInsertString(DCM_CodeValue, value.c_str()));
}

/// An item of a structure (PS3.3 C.8.20.4, C.8.8.8), with codes and a UID that its number gives.
void add_structure(DcmDataset& dataset, StructureKind kind, int number) {
  const bool is_segment = kind == StructureKind::segmentation;
  DcmItem& item = listed_item(dataset, is_segment ? DCM_SegmentSequence : DCM_RTROIObservationsSequence);
  const std::string digits = std::to_string(number);
  succeed(is_segment ? item.putAndInsertUint16(DCM_SegmentNumber, static_cast<Uint16>(number))
                     : item.putAndInsertString(DCM_ReferencedROINumber, digits.c_str()));
  add_code(item, DCM_SegmentedPropertyCategoryCodeSequence, "1" + digits);
  add_code(item, is_segment ? DCM_SegmentedPropertyTypeCodeSequence : DCM_RTROIIdentificationCodeSequence,
           "2" + digits);
  if (is_segment) succeed(item.putAndInsertString(DCM_TrackingUID, ("1.2.3." + digits).c_str()));
}

TEST(StructureLabels, OfEachStructureOfAFileAreItsOwn) {
  for (const StructureKind kind : {StructureKind::segmentation, StructureKind::contours}) {
    std::vector<int> numbers{2, 5, 9};
    do {
      const TestFolder folder;
      TestImage image;
      image.edit = [&](DcmDataset& dataset) {
        dataset.findAndDeleteElement(DCM_PixelData);
        for (const int number : numbers) add_structure(dataset, kind, number);
      };
      internal::write(image, folder / "a.dcm");
      for (const int number : {1, 2, 4, 5, 9, 10}) {
        Structure structure;
        structure.file = folder / "a.dcm";
        structure.kind = kind;
        structure.number = number;
        const StructureLabel label = label_of(structure);
        const bool is_listed = std::ranges::find(numbers, number) != numbers.end();
        const std::string digits = std::to_string(number);
        const bool is_tracked = is_listed && kind == StructureKind::segmentation;
        SCOPED_TRACE(::testing::Message() << name_of(kind) << ' ' << number << ", the first is " << numbers.front());
        EXPECT_EQ(label.category.value, is_listed ? "1" + digits : "");
        EXPECT_EQ(label.type.value, is_listed ? "2" + digits : "");
        EXPECT_EQ(label.tracking_uid, is_tracked ? "1.2.3." + digits : "");
      }
    } while (std::ranges::next_permutation(numbers).found);
  }
}

}  // namespace
}  // namespace palpate::io
