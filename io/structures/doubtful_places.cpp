#include "io/structures/doubtful_places.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <map>
#include <optional>

#include "io/parallel.h"
#include "io/quantile.h"
#include "io/structures/outline_parts.h"
#include "io/structures/outline_places.h"

namespace palpate::io {
namespace {

constexpr double apart_mm = 2;              // between places
constexpr double beside_mm = 2 * apart_mm;  // places so near are one
constexpr double least_edge_mm2 = 30;       // a smaller place is noise of a few samples
constexpr double least_no_edge_mm2 = 100;
constexpr double small_part = 0.1;        // of the largest one's volume
constexpr double least_with_edges = 0.3;  // of the outline; an organ lies at others of its own values
constexpr double alike_part = 0.25;       // of the usual rise over an edge
constexpr double beyond_edge_mm = 2.5;    // where the tissue on a side of an edge is read
constexpr double mean_of_mm = 1;          // of a tissue: the mean of values so far apart

/// The scan's edge at a place of the outline.
struct Asked {
  OutlinePlace at;
  bool is_asked = false;           ///< all of the way lies in the scan, and the place is on no island or hole
  double in = 0, out = 0;          ///< values of the tissue on both sides of the outline
  std::optional<ScanEdge> edge{};  ///< along the outward normal
  double voxel_mm = 0;             ///< along the normal
};

double value_of_tissue(const ScanValues& scan, const Vec3& at, const Vec3& way) {
  double sum = 0;
  for (const double step : {-mean_of_mm, 0.0, mean_of_mm}) {
    sum += scan.source.sample(at + step * way, FieldSet::value).value;
  }
  return sum / 3;
}

double voxel_along(const Geometry& g, const Vec3& way) {
  const Vec3 third = glm::cross(g.direction_i, g.direction_j);
  return glm::length(Vec3(g.spacing_i * glm::dot(g.direction_i, way), g.spacing_j * glm::dot(g.direction_j, way),
                          g.slice_spacing() * glm::dot(third, way)));
}

void ask(const ScanValues& scan, const DistanceField& structure, Asked& one) {
  const Vec3 outward = -one.at.inward;
  const auto is_inside = [&](double mm) {
    return scan.source.sample(one.at.place_mm + mm * outward, FieldSet::value).inside;
  };
  one.is_asked = is_inside(-doubt_within_mm) && is_inside(doubt_within_mm);
  if (!one.is_asked) return;
  const double away = beyond_edge_mm + mean_of_mm;
  one.in = value_of_tissue(scan, one.at.place_mm - away * outward, outward);
  one.out = value_of_tissue(scan, one.at.place_mm + away * outward, outward);
  one.voxel_mm = voxel_along(scan.geometry, outward);
  one.edge = scan_edge(scan, structure, one.at.place_mm, outward, doubt_within_mm);
}

/// The structure's own tissue and how much an edge of it usually rises.
struct Usual {
  double value = 0, rise = 0;
  bool has_edges = false;  ///< enough of the outline has one: where it has none is told from where it never has
};

Usual usual_of(const std::vector<Asked>& all) {
  std::vector<double> values, rises;
  std::size_t asked = 0;
  for (const Asked& one : all) {
    if (!one.is_asked) continue;
    ++asked;
    values.push_back(one.in);
    if (one.edge) rises.push_back(std::abs(one.edge->rise));
  }
  if (values.empty()) return {};
  return {.value = quantile(values, 0.5),
          .rise = rises.empty() ? 0 : quantile(rises, 0.5),
          .has_edges = least_with_edges * static_cast<double>(asked) < static_cast<double>(rises.size())};
}

/// Whether what ends at the edge is more like the structure than what begins there.
bool ends_the_structure(const ScanValues& scan, const Asked& one, double usual_value) {
  const Vec3 outward = -one.at.inward;
  const Vec3 at = one.at.place_mm + one.edge->mm * outward;
  const double in = scan.source.sample(at - beyond_edge_mm * outward, FieldSet::value).value;
  const double out = scan.source.sample(at + beyond_edge_mm * outward, FieldSet::value).value;
  return std::abs(in - usual_value) < std::abs(out - usual_value);
}

enum class Doubt : std::uint8_t { none, outside, inside, no_edge };

Doubt doubt_of(const Asked& one, const Usual& usual) {
  if (!one.is_asked) return Doubt::none;
  if (!one.edge) {
    return usual.has_edges && std::abs(one.out - one.in) < alike_part * usual.rise ? Doubt::no_edge : Doubt::none;
  }
  if (std::abs(one.edge->mm) <= std::max(2 * one.edge->known_to_mm, 0.5 * one.voxel_mm)) return Doubt::none;
  return one.edge->mm > 0 ? Doubt::outside : Doubt::inside;
}

/// Places by the cell of a lattice that they lie in.
class PlaceGrid {
 public:
  explicit PlaceGrid(const std::vector<Asked>& all) : all_(all) {
    for (std::size_t n = 0; n < all.size(); ++n) cells_[cell_of(all[n].at.place_mm)].push_back(n);
  }
  /// Those on the same wall within `beside_mm` of one.
  std::vector<std::size_t> beside(std::size_t one) const {
    std::vector<std::size_t> found;
    const std::array<int, 3> cell = cell_of(all_[one].at.place_mm);
    for (int n = 0; n < 27; ++n) {
      const auto in_cell = cells_.find({cell[0] + n % 3 - 1, cell[1] + n / 3 % 3 - 1, cell[2] + n / 9 - 1});
      if (in_cell == cells_.end()) continue;
      for (const std::size_t other : in_cell->second) {
        const bool near = glm::distance(all_[one].at.place_mm, all_[other].at.place_mm) <= beside_mm;
        if (near && glm::dot(all_[one].at.inward, all_[other].at.inward) > 0) found.push_back(other);
      }
    }
    return found;
  }

 private:
  static std::array<int, 3> cell_of(const Vec3& at) {
    const glm::ivec3 cell(glm::floor(at / beside_mm));
    return {cell.x, cell.y, cell.z};
  }
  const std::vector<Asked>& all_;
  std::map<std::array<int, 3>, std::vector<std::size_t>> cells_;
};

/// A place is doubtful only if half of its neighbors are doubtful in the same way.
std::vector<Doubt> confirmed(const std::vector<Doubt>& doubts, const PlaceGrid& grid) {
  std::vector<Doubt> kept = doubts;
  for (std::size_t n = 0; n < doubts.size(); ++n) {
    if (doubts[n] == Doubt::none) continue;
    const auto around = grid.beside(n);
    const auto alike = std::ranges::count_if(around, [&](std::size_t other) { return doubts[other] == doubts[n]; });
    if (2 * static_cast<std::size_t>(alike) < around.size()) kept[n] = Doubt::none;
  }
  return kept;
}

DoubtfulPlace joined(const std::vector<Asked>& all, const std::vector<std::size_t>& members, Doubt doubt) {
  DoubtfulPlace place{.kind = doubt == Doubt::no_edge ? DoubtKind::no_edge : DoubtKind::edge};
  Vec3 middle(0);
  for (const std::size_t n : members) {
    const Asked& one = all[n];
    place.area_mm2 += one.at.area_mm2;
    middle += one.at.area_mm2 * one.at.place_mm;
    if (doubt == Doubt::no_edge) continue;
    place.mean_mm += one.at.area_mm2 * one.edge->mm;
    place.known_to_mm += one.at.area_mm2 * one.edge->known_to_mm;
    if (std::abs(one.edge->mm) > std::abs(place.largest_mm)) place.largest_mm = one.edge->mm;
  }
  middle /= place.area_mm2;
  place.mean_mm /= place.area_mm2;
  place.known_to_mm /= place.area_mm2;
  const std::size_t nearest =
      *std::ranges::min_element(members, {}, [&](std::size_t n) { return glm::distance(all[n].at.place_mm, middle); });
  place.position_mm = all[nearest].at.place_mm;
  place.normal = -all[nearest].at.inward;
  return place;
}

void add_regions(const std::vector<Asked>& all, const std::vector<Doubt>& doubts, const PlaceGrid& grid,
                 std::vector<DoubtfulPlace>& places) {
  std::vector<char> taken(all.size(), 0);
  for (std::size_t first = 0; first < all.size(); ++first) {
    if (doubts[first] == Doubt::none || taken[first] != 0) continue;
    std::vector<std::size_t> members{first};
    taken[first] = 1;
    for (std::size_t n = 0; n < members.size(); ++n) {
      for (const std::size_t other : grid.beside(members[n])) {
        if (taken[other] != 0 || doubts[other] != doubts[first]) continue;
        taken[other] = 1;
        members.push_back(other);
      }
    }
    const DoubtfulPlace place = joined(all, members, doubts[first]);
    if (place.area_mm2 >= (place.kind == DoubtKind::no_edge ? least_no_edge_mm2 : least_edge_mm2)) {
      places.push_back(place);
    }
  }
}

/// Small parts and holes: which places lie on one of them, and each as a place.
std::vector<char> add_parts(const ScanValues& scan, const DistanceField& structure,
                            const std::vector<OutlinePlace>& outline, std::vector<DoubtfulPlace>& places) {
  std::vector<std::size_t> of_place;
  const std::vector<OutlinePart> parts = outline_parts(structure, outline, &of_place);
  double most_mm3 = 0;
  for (const OutlinePart& part : parts) most_mm3 = std::max(most_mm3, part.is_hole ? 0 : part.volume_mm3);
  std::vector<char> is_small(parts.size()), on_small(outline.size());
  for (std::size_t n = 0; n < parts.size(); ++n) is_small[n] = parts[n].volume_mm3 < small_part * most_mm3 ? 1 : 0;
  std::vector<DoubtfulPlace> small(parts.size());
  std::vector<double> nearest(parts.size(), 1e300);
  for (std::size_t n = 0; n < outline.size(); ++n) {
    const std::size_t of = of_place[n];
    on_small[n] = is_small[of];
    DoubtfulPlace& place = small[of];
    place.area_mm2 += outline[n].area_mm2;
    const double away = glm::distance(outline[n].place_mm, parts[of].deepest_mm);
    if (away >= nearest[of]) continue;
    nearest[of] = away;
    place.position_mm = outline[n].place_mm;
    place.normal = -outline[n].inward;
  }
  for (std::size_t n = 0; n < parts.size(); ++n) {
    if (is_small[n] == 0 || !(small[n].area_mm2 > 0)) continue;
    // Beyond the scan's ends a structure is continued with the shape of its end; parts there were not outlined.
    if (!scan.source.sample(parts[n].deepest_mm, FieldSet::value).inside) continue;
    const double sign = parts[n].is_hole ? 1 : -1;  // where the edge would go to if it were not there
    small[n].kind = parts[n].is_hole ? DoubtKind::hole : DoubtKind::island;
    small[n].mean_mm = sign * parts[n].volume_mm3 / small[n].area_mm2;
    small[n].largest_mm = sign * parts[n].depth_mm;
    places.push_back(small[n]);
  }
  return on_small;
}

/// Nobody knows how far away an edge is that was not found: as far as it was looked for.
double weight_of(const DoubtfulPlace& place) {
  return place.area_mm2 * (place.kind == DoubtKind::no_edge ? doubt_within_mm : std::abs(place.mean_mm));
}

}  // namespace

const char* name_of(DoubtKind kind) noexcept {
  constexpr std::array names{"edge", "no_edge", "island", "hole"};
  return names.at(static_cast<std::size_t>(kind));
}

DoubtfulPlaces doubtful_places(const ScanValues& scan, const DistanceField& structure, const Progress& progress,
                               int threads) {
  DoubtfulPlaces found;
  const std::vector<OutlinePlace> outline = outline_places(structure, apart_mm);
  const std::vector<char> on_small = add_parts(scan, structure, outline, found.places);
  std::vector<Asked> all(outline.size());
  internal::parallel_for(
      all.size(),
      [&](std::size_t n) {
        all[n].at = outline[n];
        if (on_small[n] == 0) ask(scan, structure, all[n]);
      },
      progress, threads);
  const Usual usual = usual_of(all);
  std::vector<Doubt> doubts(all.size());
  for (std::size_t n = 0; n < all.size(); ++n) {
    Asked& one = all[n];
    if (one.edge && !ends_the_structure(scan, one, usual.value)) one.edge.reset();
    found.sampled += one.is_asked ? 1 : 0;
    found.without_edge += one.is_asked && !one.edge ? 1 : 0;
    doubts[n] = doubt_of(one, usual);
  }
  const PlaceGrid grid(all);
  add_regions(all, confirmed(doubts, grid), grid, found.places);
  std::ranges::stable_sort(found.places, std::greater<>(), weight_of);
  return found;
}

}  // namespace palpate::io
