#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <dcmtk/dcmdata/dcitem.h>
#include <dcmtk/dcmdata/dcsequen.h>

#include <cmath>
#include <memory>

#include "io/dicom/dataset.h"
#include "io/dicom/dicom_value.h"
#include "io/dicom/planes.h"

namespace palpate::io::internal {
namespace {

constexpr Uint16 uih = 0x0065;
constexpr const char* creator = "Image Private Header";
const DcmTagKey count_tag(uih, 0x1050), slices_tag(uih, 0x1051);

std::vector<Placement> places_in(DcmSequenceOfItems& slices, const std::vector<double>& orientation,
                                 const std::vector<double>& spacing) {
  std::vector<Placement> places;
  DcmObject* object = nullptr;
  while ((object = slices.nextInContainer(object)) != nullptr) {
    auto* item = dynamic_cast<DcmItem*>(object);
    if (item == nullptr) return {};
    const auto place = make_placement(numbers_of(*item, DCM_ImagePositionPatient), orientation, spacing);
    if (!place) return {};
    places.push_back(*place);
  }
  return places;
}

// One item a slice. The dictionary does not know the sequence: where its VR is not written, it is bytes.
std::vector<Placement> places_of(DcmItem& dataset) {
  const std::vector<double> orientation = numbers_of(dataset, DCM_ImageOrientationPatient);
  const std::vector<double> spacing = numbers_of(dataset, DCM_PixelSpacing);
  DcmElement* element = nullptr;
  if (dataset.findAndGetElement(slices_tag, element).bad()) return {};
  if (auto* sequence = dynamic_cast<DcmSequenceOfItems*>(element)) return places_in(*sequence, orientation, spacing);
  Uint8* bytes = nullptr;
  if (element->getUint8Array(bytes).bad() || bytes == nullptr) return {};
  const auto sequence = sequence_in(std::as_bytes(std::span(bytes, element->getLength())));
  return sequence ? places_in(*sequence, orientation, spacing) : std::vector<Placement>();
}

}  // namespace

std::vector<Plane> grid_planes(DcmItem& dataset, FileHeader& header) {
  if (text_of(dataset, DcmTagKey(uih, 0x0010)) != creator) return {};
  const double count = number_of(dataset, count_tag).value_or(0);
  const std::vector<Placement> places = places_of(dataset);
  if (count < 1 || count > 4096 || static_cast<double>(places.size()) < count) return {};
  const int tiles = static_cast<int>(count);
  const int across = static_cast<int>(std::ceil(std::sqrt(tiles)));
  const int down = (tiles + across - 1) / across;
  header.columns = header.format.columns / across;
  header.rows = header.format.rows / down;
  if (header.columns < 1 || header.rows < 1) return {};
  const Plane whole = classic_plane(dataset, header);
  std::vector<Plane> planes;
  for (int tile = 0; tile < tiles; ++tile) {
    Plane plane = whole;
    plane.tile_column = static_cast<std::uint32_t>(tile % across * header.columns);
    plane.tile_row = static_cast<std::uint32_t>(tile / across * header.rows);
    plane.placement = places[static_cast<std::size_t>(tile)];
    planes.push_back(std::move(plane));
  }
  return planes;
}

}  // namespace palpate::io::internal
