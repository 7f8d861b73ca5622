// Names and ids outside ASCII: structures and registrations give the same text in every character set.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dctk.h>
#include <gtest/gtest.h>

#include <array>
#include <string>

#include "io/structures/structure.h"
#include "io/testing/test_image.h"
#include "io/testing/test_segmentation.h"

namespace palpate::io {
namespace {

using internal::put;
using internal::TestFolder;

/// A name as bytes of a character set, and as UTF-8. From PS3.5 annexes H, I and J, and from iconv's tables.
struct WrittenName {
  const char* characters;
  std::string bytes, utf8;
};

const std::array written_names{
    WrittenName{"", "Doe^Jane", "Doe^Jane"},
    WrittenName{"ISO_IR 192", "M\u00fcller^\u00c4nne", "M\u00fcller^\u00c4nne"},
    WrittenName{"ISO_IR 100", "M\xfcller^\xc4nne", "M\u00fcller^\u00c4nne"},
    WrittenName{"ISO_IR 101", "Nov\xe1k^Ji\xf8\xed", "Nov\u00e1k^Ji\u0159\u00ed"},
    WrittenName{"ISO_IR 144", "\xbb\xee\xda\x63\x65\xdc\x62\x79\x70\x72", "\u041b\u044e\u043ace\u043cbypr"},
    WrittenName{"ISO_IR 126", "\xc4\xe9\xef\xed\xf5\xf3\xe9\xef\xf2",
                "\u0394\u03b9\u03bf\u03bd\u03c5\u03c3\u03b9\u03bf\u03c2"},
    WrittenName{"GB18030", "Wang^\xd0\xa1\xb6\xab", "Wang^\u5c0f\u4e1c"},
    WrittenName{"\\ISO 2022 IR 87", "Yamada^Tarou=\x1b$B;3ED\x1b(B^\x1b$BB@O:\x1b(B",
                "Yamada^Tarou=\u5c71\u7530^\u592a\u90ce"},
    WrittenName{"\\ISO 2022 IR 149", "Hong^Gildong=\x1b$)C\xfb\xf3^\x1b$)C\xd1\xce\xd4\xd7",
                "Hong^Gildong=\u6d2a^\u5409\u6d1e"}};

void put_patient(DcmDataset& dataset, const WrittenName& name) {
  put(dataset, DCM_SpecificCharacterSet, name.characters);
  put(dataset, DCM_PatientName, name.bytes);
  put(dataset, DCM_PatientID, name.bytes);
}

TEST(PatientLetters, OfSegmentsContoursAndRegistrationsAreDecoded) {
  for (const WrittenName& name : written_names) {
    const TestFolder folder;
    internal::TestSegmentation segments{.frames = {{1, 0, [](int i, int) { return i % 2; }}}};
    segments.edit = [&](DcmDataset& dataset) { put_patient(dataset, name); };
    internal::write(segments, folder / "a.dcm");
    internal::TestImage contours;
    contours.edit = [&](DcmDataset& dataset) {
      dataset.findAndDeleteElement(DCM_PixelData);
      put(dataset, DCM_SOPClassUID, "1.2.840.10008.5.1.4.1.1.481.3");
      put_patient(dataset, name);
      DcmItem* roi = nullptr;
      internal::succeed(dataset.findOrCreateSequenceItem(DCM_StructureSetROISequence, roi, -2));
      internal::succeed(roi->putAndInsertString(DCM_ROINumber, "1"));
      internal::succeed(roi->putAndInsertString(DCM_ROIName, name.bytes.c_str()));
    };
    internal::write(contours, folder / "b.dcm");
    internal::TestImage registration;
    registration.edit = [&](DcmDataset& dataset) {
      dataset.findAndDeleteElement(DCM_PixelData);
      put(dataset, DCM_SOPClassUID, "1.2.840.10008.5.1.4.1.1.66.1");
      put_patient(dataset, name);
    };
    internal::write(registration, folder / "c.dcm");
    const StructureCatalogue found = find_structures(std::array{folder.path()});
    ASSERT_EQ(found.structures.size(), 2U) << name.utf8;
    for (const Structure& structure : found.structures) {
      EXPECT_EQ(structure.patient_name, name.utf8) << name_of(structure.kind);
      EXPECT_EQ(structure.patient_id, name.utf8) << name_of(structure.kind);
    }
    EXPECT_EQ(found.structures[1].name, name.utf8);
    ASSERT_EQ(found.registrations.size(), 1U) << name.utf8;
    EXPECT_EQ(found.registrations[0].patient_id, name.utf8);
    const std::array files{folder / "a.dcm", folder / "b.dcm", folder / "c.dcm"};
    const auto alone = find_registrations(files);
    ASSERT_EQ(alone.size(), 1U);
    EXPECT_EQ(alone[0].patient_id, name.utf8);
  }
}

}  // namespace
}  // namespace palpate::io
