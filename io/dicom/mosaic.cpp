#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <dcmtk/dcmdata/dcelem.h>
#include <dcmtk/dcmdata/dcitem.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "io/dicom/csa_header.h"
#include "io/dicom/dicom_value.h"
#include "io/dicom/planes.h"

namespace palpate::io::internal {
namespace {

// Element 0x10 of the block that Siemens reserved in group 0029.
std::span<const std::byte> csa_header_of(DcmItem& dataset) {
  for (unsigned block = 0x10; block <= 0xFF; ++block) {
    if (text_of(dataset, DcmTagKey(0x0029, static_cast<Uint16>(block))) != "SIEMENS CSA HEADER") continue;
    DcmElement* element = nullptr;
    Uint8* bytes = nullptr;
    if (dataset.findAndGetElement(DcmTagKey(0x0029, static_cast<Uint16>(block << 8 | 0x10)), element).bad() ||
        element->getUint8Array(bytes).bad() || bytes == nullptr) {
      return {};
    }
    return std::as_bytes(std::span(bytes, element->getLength()));
  }
  return {};
}

}  // namespace

std::vector<Plane> mosaic_planes(DcmItem& dataset, FileHeader& header) {
  if (header.image_type.find("MOSAIC") == std::string::npos) return {};
  const auto csa = csa_header_of(dataset);
  const auto count = csa_numbers(csa, "NumberOfImagesInMosaic");
  const auto normal = csa_numbers(csa, "SliceNormalVector");
  if (count.empty() || count[0] < 1 || count[0] > 4096 || normal.size() < 3) return {};
  Plane whole = classic_plane(dataset, header);
  if (!whole.placement) return {};

  const int tiles = static_cast<int>(count[0]);
  const int across = static_cast<int>(std::ceil(std::sqrt(tiles)));
  header.columns = header.format.columns / across;
  header.rows = header.format.rows / across;
  if (header.columns < 1 || header.rows < 1) return {};

  // The file's position is that of the first pixel of an image as large as the mosaic, centered at the first slice's
  // center.
  Placement& place = *whole.placement;
  place.position += place.spacing_i * 0.5 * (header.format.columns - header.columns) * place.direction_i +
                    place.spacing_j * 0.5 * (header.format.rows - header.rows) * place.direction_j;
  const double distance = number_of(dataset, DCM_SpacingBetweenSlices).value_or(header.thickness);
  if (!(distance > 0)) return {};
  const Vec3 across_slices = glm::cross(place.direction_i, place.direction_j);
  const double sense = glm::dot(across_slices, Vec3(normal[0], normal[1], normal[2])) < 0 ? -1 : 1;

  if (const auto b = csa_numbers(csa, "B_value"); !b.empty()) {
    whole.labels[static_cast<std::size_t>(Label::b_value)] = std::to_string(std::lround(b.front()));
  }
  std::vector<Plane> planes;
  for (int tile = 0; tile < tiles; ++tile) {
    Plane plane = whole;
    plane.tile_column = static_cast<std::uint32_t>(tile % across * header.columns);
    plane.tile_row = static_cast<std::uint32_t>(tile / across * header.rows);
    plane.placement->position += tile * distance * sense * across_slices;
    planes.push_back(std::move(plane));
  }
  return planes;
}

}  // namespace palpate::io::internal
