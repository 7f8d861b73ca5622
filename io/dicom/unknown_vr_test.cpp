// Attributes that an archive wrote with the VR UN because it did not know them (PS3.5 6.2.2): the values are those of
// the same file with its own VRs.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcostrmb.h>
#include <dcmtk/dcmdata/dcsequen.h>
#include <dcmtk/dcmdata/dcvrobow.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <memory>

#include "io/load.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::SizeIs;

/// The value of an element as it is written without a VR.
std::vector<Uint8> implicit_value(DcmElement& element) {
  std::vector<Uint8> bytes(1U << 16);
  DcmOutputBufferStream out(bytes.data(), static_cast<offile_off_t>(bytes.size()));
  element.transferInit();
  succeed(element.write(out, EXS_LittleEndianImplicit, EET_ExplicitLength, nullptr));
  element.transferEnd();
  bytes.resize(static_cast<std::size_t>(out.tell()));
  bytes.erase(bytes.begin(), bytes.begin() + 8);  // tag and length
  return bytes;
}

/// Writes all attributes but those of a file's own bookkeeping as unknown ones.
void make_unknown(DcmDataset& d) {
  std::vector<DcmElement*> elements;
  DcmObject* object = nullptr;
  while ((object = d.nextInContainer(object)) != nullptr) elements.push_back(dynamic_cast<DcmElement*>(object));
  for (DcmElement* element : elements) {
    const DcmTagKey key = element->getTag();
    if (key == DCM_SOPClassUID || key == DCM_SOPInstanceUID || key == DCM_PixelData) continue;
    const std::vector<Uint8> value = implicit_value(*element);
    auto unknown = std::make_unique<DcmOtherByteOtherWord>(DcmTag(key, EVR_UN));
    succeed(unknown->putUint8Array(value.data(), static_cast<unsigned long>(value.size())));
    succeed(d.insert(unknown.release(), OFTrue));
  }
}

TEST(UnknownVr, KnownAttributesAreReadAsWhatTheyAre) {
  const TestFolder folder;
  write_stack(folder.path(), 4, [](int, TestImage& image) {
    image.edit = [](DcmDataset& d) {
      put(d, DCM_RescaleSlope, "2");
      put(d, DCM_RescaleIntercept, "-1024");
      put(d, DCM_SeriesDescription, "as it was");
      put(d, DCM_PixelPaddingValue, 132);
      make_unknown(d);
    };
  });
  const Catalogue found = find_in(folder);
  EXPECT_THAT(found.skipped, IsEmpty());
  ASSERT_THAT(found.series, SizeIs(1));
  const Series& series = found.series[0];
  EXPECT_EQ(series.description, "as it was");
  EXPECT_EQ(series.modality, "CT");
  EXPECT_EQ(series.unit, "HU");
  EXPECT_EQ(series.uid, "1.2.3.4");
  const Volume volume = load(series);
  EXPECT_EQ(volume.geometry.dimensions, glm::ivec3(6, 4, 4));
  EXPECT_EQ(volume.geometry.spacing_i, 0.75);
  EXPECT_EQ(volume.geometry.step.z, 2);
  EXPECT_EQ(volume.value_at(5, 1, 2), 2 * 251 - 1024);
  EXPECT_TRUE(volume.is_padding(3, 2, 1));
}

TEST(UnknownVr, LocalizerIsRecognized) {
  const TestFolder folder;
  write_stack(folder.path(), 3, [](int, TestImage& image) {
    image.edit = [](DcmDataset& d) {
      put(d, DCM_ImageType, "ORIGINAL\\PRIMARY\\LOCALIZER");
      make_unknown(d);
    };
  });
  const Series series = find_in(folder).series.at(0);
  EXPECT_FALSE(series.usable);
  EXPECT_THAT(series.warnings.front(), HasSubstr("a localizer"));
}

TEST(UnknownVr, FunctionalGroupsAreRead) {
  const TestFolder folder;
  TestImage image;
  image.edit = [](DcmDataset& d) {
    repeat_pixels(d, 3);
    make_multi_frame(d, {1, 4, 7}, [](std::size_t f, DcmItem& frame) {
      succeed(group(frame, DCM_PixelValueTransformationSequence)
                  .putAndInsertString(DCM_RescaleSlope, std::to_string(f + 1).c_str()));
    });
    make_unknown(d);
  };
  write(image, folder / "enhanced");
  const Catalogue found = find_in(folder);
  ASSERT_THAT(found.series, SizeIs(1));
  const Volume volume = load(found.series[0]);
  ASSERT_EQ(volume.geometry.dimensions.z, 3);
  EXPECT_EQ(volume.geometry.slice_positions[2].z, 7);
  for (int k = 0; k < 3; ++k) EXPECT_EQ(volume.value_at(4, 1, k), (k + 1) * 41);
}

}  // namespace
}  // namespace palpate::io::internal
