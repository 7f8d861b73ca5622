#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/vec2.hpp>
#include <utility>

#include "io/parallel.h"
#include "io/structures/grid_box.h"
#include "io/structures/keyholes.h"
#include "io/structures/label_image.h"
#include "io/structures/zero_lines.h"

namespace palpate::io {
namespace {

/// A slice's lattice, twice as fine as its voxels, from the outer edges of its outermost ones. Around it lies a ring of
/// nodes on the same edges, which counts as outside: there the structure ends.
struct FineLattice {
  glm::dvec2 first{0};  ///< index of the first node within the ring
  glm::ivec2 nodes{0};  ///< with the ring

  glm::dvec2 index(const glm::dvec2& node) const {
    return first + (glm::clamp(node, glm::dvec2(1), glm::dvec2(nodes) - 2.0) - 1.0) / 2.0;
  }
};

FineLattice lattice_around(const IndexBox& box) {
  const glm::ivec2 low(box.low), high(box.high);
  return {glm::dvec2(low) - 0.5, 2 * (high - low) + 5};
}

std::vector<std::vector<Vec3>> contours_of(const Geometry& scan, const SignedDistance& distance, int k,
                                           const FineLattice& lattice) {
  const glm::ivec2& n = lattice.nodes;
  std::vector<double> values(static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y));
  for (int j = 0; j < n.y; ++j) {
    for (int i = 0; i < n.x; ++i) {
      const bool is_ring = i == 0 || j == 0 || i == n.x - 1 || j == n.y - 1;
      values[static_cast<std::size_t>(j) * static_cast<std::size_t>(n.x) + static_cast<std::size_t>(i)] =
          is_ring ? -1 : distance(scan.to_patient(Vec3(lattice.index({i, j}), k)));
    }
  }
  const glm::dvec2 spacing(scan.spacing_i, scan.spacing_j);
  std::vector<ContourPolygon> lines = zero_lines(values, n);
  for (ContourPolygon& line : lines) {
    for (glm::dvec2& point : line) point = lattice.index(point) * spacing;
  }
  std::vector<std::vector<Vec3>> contours;
  for (const ContourPolygon& polygon : with_keyholes(thinned(lines))) {
    std::vector<Vec3>& contour = contours.emplace_back();
    contour.reserve(polygon.size());
    for (const glm::dvec2& point : polygon) contour.push_back(scan.to_patient(Vec3(point / spacing, k)));
  }
  return contours;
}

}  // namespace

SliceContours trace_slices(StructureLabel label, const Geometry& scan, const SignedDistance& distance,
                           const std::optional<StructureBox>& within, const Progress& progress) {
  const IndexBox box = index_box(scan, within);
  const FineLattice lattice = lattice_around(box);
  std::vector<SliceContours::Slice> slices(static_cast<std::size_t>(box.high.z - box.low.z + 1));
  internal::parallel_for(
      slices.size(),
      [&](std::size_t n) {
        slices[n].k = box.low.z + static_cast<int>(n);
        slices[n].contours = contours_of(scan, distance, slices[n].k, lattice);
      },
      progress, 0);
  std::erase_if(slices, [](const SliceContours::Slice& slice) { return slice.contours.empty(); });
  return {std::move(label), scan, std::move(slices)};
}

}  // namespace palpate::io
