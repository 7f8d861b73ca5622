// The diffusion weighting in each maker's form.
#include "io/dicom/b_value.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdatset.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <gtest/gtest.h>

#include <array>

#include "io/dicom/dcmtk_start.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {
namespace {

struct Maker {
  Uint16 group;
  const char* creator;
  Uint16 element;
};

constexpr std::array makers{Maker{0x0019, "SIEMENS MR HEADER", 0x100C}, Maker{0x0043, "GEMS_PARM_01", 0x1039},
                            Maker{0x0065, "Image Private Header", 0x1009},
                            Maker{0x2001, "Philips Imaging DD 001", 0x1003}};

void add(DcmDataset& dataset, const Maker& maker, const char* value) {
  succeed(dataset.putAndInsertString(DcmTag(maker.group, 0x0010, EVR_LO), maker.creator));
  succeed(dataset.putAndInsertString(DcmTag(maker.group, maker.element, EVR_IS), value));
}

TEST(BValue, IsThatOfEachMaker) {
  start_dcmtk();
  for (const Maker& maker : makers) {
    for (const auto& [written, b] : {std::pair{"800", 800.0}, {"0", 0.0}, {"1000000800\\8\\0\\0", 800.0}}) {
      DcmDataset dataset;
      add(dataset, maker, written);
      EXPECT_EQ(b_value_of(dataset), b) << maker.creator;
    }
    DcmDataset negative, another;
    add(negative, maker, "-1");
    EXPECT_FALSE(b_value_of(negative)) << maker.creator;
    add(another, maker, "800");
    succeed(another.putAndInsertString(DcmTag(maker.group, 0x0010, EVR_LO), "SOMEBODY ELSE"));
    EXPECT_FALSE(b_value_of(another)) << maker.creator;
  }
}

TEST(BValue, OfTheStandardGoesFirst) {
  DcmDataset dataset;
  EXPECT_FALSE(b_value_of(dataset));
  for (const Maker& maker : makers) add(dataset, maker, "800");
  succeed(dataset.putAndInsertFloat64(DCM_DiffusionBValue, 1200));
  EXPECT_EQ(b_value_of(dataset), 1200);
}

}  // namespace
}  // namespace palpate::io::internal
