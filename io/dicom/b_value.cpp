#include "io/dicom/b_value.h"

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdeftag.h>

#include <array>
#include <cmath>

#include "io/dicom/dicom_value.h"

namespace palpate::io::internal {
namespace {

struct PrivateAttribute {
  Uint16 group;
  const char* creator;  // all of them are met in the first block of their group
  Uint16 element;
};

constexpr std::array attributes{PrivateAttribute{0x0019, "SIEMENS MR HEADER", 0x100C},
                                PrivateAttribute{0x0043, "GEMS_PARM_01", 0x1039},
                                PrivateAttribute{0x0065, "Image Private Header", 0x1009},
                                PrivateAttribute{0x2001, "Philips Imaging DD 001", 0x1003}};

}  // namespace

std::optional<double> b_value_of(DcmItem& dataset) {
  if (const auto standard = number_of(dataset, DCM_DiffusionBValue)) return standard;
  for (const PrivateAttribute& attribute : attributes) {
    if (text_of(dataset, DcmTagKey(attribute.group, 0x0010)) != attribute.creator) continue;
    const auto value = number_of(dataset, DcmTagKey(attribute.group, attribute.element));
    // GE adds 1e9 to a rounded value.
    if (value && *value >= 0) return std::fmod(*value, 1e9);
  }
  return std::nullopt;
}

}  // namespace palpate::io::internal
