// What lies where, against what phantoms say, and on real scans against a flood of the air at the scan's own voxels.
#include "modes/scene/regions.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <glm/geometric.hpp>
#include <glm/trigonometric.hpp>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

#include "io/fields/volume_fields.h"
#include "io/load.h"
#include "io/series.h"
#include "modes/scene/boundary_names.h"
#include "modes/scene/edge_sites.h"
#include "modes/scene/site_map.h"
#include "modes/scene/suggest.h"
#include "solver/text/testing/sanitized.h"
#include "testdata/scan.h"

namespace palpate::modes::internal {
namespace {

using testdata::Cylinder;
using testdata::HalfSpace;

/// make_chest(), with the table as far behind the body as told, mm.
testdata::Phantom chest(double gap_mm) {
  testdata::Phantom phantom = testdata::make_chest();
  phantom.bodies[0].shape = HalfSpace{{0, -1, 0}, -160 - gap_mm};
  phantom.bodies[1].shape = HalfSpace{{0, -1, 0}, -172 - gap_mm};
  return phantom;
}

Region truth_at(const Vec3& at, double gap_mm) {
  const auto in = [&](double x, double y, double radius) {
    return glm::length(glm::dvec2(at.x - x, at.y - y)) < radius;
  };
  if (at.y > 160 + gap_mm && at.y < 172 + gap_mm) return Region::table;
  if (!in(0, 0, 160)) return Region::room;
  if (in(0, 30, 9)) return Region::inner_air;
  if (glm::length(at - Vec3(15, -40, -40)) < 45) return Region::body;
  return in(-75, -10, 55) || in(75, -10, 55) ? Region::lung : Region::body;
}

/// Whether all within a distance of a place is of one region.
bool is_clear(const Vec3& at, double mm, double gap_mm) {
  const Region here = truth_at(at, gap_mm);
  for (int n = 0; n < 26; ++n) {
    const int m = n < 13 ? n : n + 1;
    const Vec3 way = glm::normalize(Vec3(m % 3 - 1, m / 3 % 3 - 1, m / 9 - 1));
    if (truth_at(at + mm * way, gap_mm) != here) return false;
  }
  return true;
}

struct ChestScan {
  std::string name;
  testdata::Grid grid;
  double noise = 20, gap_mm = 8;
};

std::vector<ChestScan> chest_scans() {
  testdata::Grid axial{.size = {144, 152, 24}, .spacing = {2.5, 2.5, 2.5}};
  testdata::Grid coronal = axial;
  coronal.direction_j = {0, 0, -1};
  coronal.size = {144, 24, 152};
  testdata::Grid tilted = axial;
  tilted.tilt_degrees = 15;
  testdata::Grid thick = axial;
  thick.size.z = 3;
  thick.spacing.z = 5;
  return {{"axial", axial},
          {"coronal", coronal},
          {"tilted", tilted},
          {"thick", thick},
          {"noisy", axial, 60},
          {"on the table", axial, 20, 0},
          {"rotated", rotated(axial, {0, 0, 1}, 20)}};
}

TEST(Regions, are_those_of_a_chest_on_a_table) {
  for (const ChestScan& chest_scan : chest_scans()) {
    const io::Volume volume =
        testdata::scan(chest(chest_scan.gap_mm), testdata::make_geometry(chest_scan.grid), {.noise = chest_scan.noise});
    const Regions regions(volume);
    std::array<int, 6> right{}, wrong{};
    for (int k = 0; k < volume.geometry.dimensions.z; k += 2) {
      for (int j = 0; j < volume.geometry.dimensions.y; j += 3) {
        for (int i = 0; i < volume.geometry.dimensions.x; i += 3) {
          const Vec3 at = volume.geometry.to_patient({i, j, k});
          // A patient on the table is joined with it where they touch.
          if (!is_clear(at, 4, chest_scan.gap_mm) || (chest_scan.gap_mm == 0 && at.y > 140)) continue;
          const Region truth = truth_at(at, chest_scan.gap_mm);
          ++(regions.at({i, j, k}) == truth ? right : wrong)[static_cast<std::size_t>(truth)];
        }
      }
    }
    for (const Region region : {Region::room, Region::lung, Region::inner_air, Region::body}) {
      EXPECT_EQ(wrong[static_cast<std::size_t>(region)], 0) << chest_scan.name << ", " << static_cast<int>(region);
      EXPECT_GT(right[static_cast<std::size_t>(region)], 0) << chest_scan.name << ", " << static_cast<int>(region);
    }
    EXPECT_EQ(wrong[static_cast<std::size_t>(Region::table)], 0) << chest_scan.name;
  }
}

/// Points on the surface of each thing, with its normal.
TEST(Regions, tell_at_which_site_a_surface_is_met) {
  struct Surface {
    const char* name;
    double x, y, radius;
    double inwards;  // +1: solid inside
    Site site;
  };
  const std::array surfaces{Surface{"skin", 0, 0, 160, 1, Site::skin},
                            Surface{"right lung", -75, -10, 55, -1, Site::lung},
                            Surface{"trachea", 0, 30, 9, -1, Site::inner_air}};
  for (const ChestScan& chest_scan : chest_scans()) {
    const io::Volume volume =
        testdata::scan(chest(chest_scan.gap_mm), testdata::make_geometry(chest_scan.grid), {.noise = chest_scan.noise});
    const Regions regions(volume);
    const auto site_at = [&](const Vec3& at, const Vec3& gradient) {
      const glm::ivec3 voxel(glm::round(volume.geometry.to_index(at)));
      return site_of(regions.sides(volume.geometry, voxel, gradient, 9));
    };
    const double z = volume.geometry.to_patient(0.5 * Vec3(volume.geometry.dimensions - 1)).z;
    int met = 0;
    for (const Surface& surface : surfaces) {
      for (int degrees = 0; degrees < 360; degrees += 5) {
        const double angle = glm::radians(static_cast<double>(degrees));
        const Vec3 out(std::cos(angle), std::sin(angle), 0);
        const Vec3 at = Vec3(surface.x, surface.y, z) + surface.radius * out;
        const bool is_scanned = volume.geometry.contains(volume.geometry.to_index(at + 8.0 * out)) &&
                                volume.geometry.contains(volume.geometry.to_index(at - 8.0 * out));
        if (!is_scanned || (chest_scan.gap_mm == 0 && at.y > 140)) continue;
        ++met;
        EXPECT_EQ(site_at(at, -surface.inwards * out), surface.site)
            << chest_scan.name << ", " << surface.name << " at " << degrees;
      }
    }
    EXPECT_GT(met, 100) << chest_scan.name;
    if (chest_scan.grid.tilt_degrees > 0) continue;  // the table is elsewhere in it
    EXPECT_EQ(site_at({100, 160 + chest_scan.gap_mm, z}, {0, 1, 0}), Site::table) << chest_scan.name;
    EXPECT_EQ(site_at({100, 172 + chest_scan.gap_mm, z}, {0, -1, 0}), Site::table) << chest_scan.name;
  }
}

TEST(SiteMap, tells_sites_of_a_ct_alone) {
  io::Volume volume = testdata::scan(chest(8), testdata::make_geometry(chest_scans().front().grid), {.noise = 20});
  const SiteMap map(std::make_shared<const io::Volume>(volume));
  EXPECT_EQ(map.at({-160, 0, 0}, {1, 0, 0}), Site::skin);
  EXPECT_EQ(map.at({-130, -10, 0}, {-2, 0, 0}), Site::lung);
  EXPECT_EQ(map.at({500, 500, 500}, {1, 0, 0}), Site::elsewhere);
  volume.unit = "";
  EXPECT_EQ(SiteMap(std::make_shared<const io::Volume>(volume)).at({-160, 0, 0}, {1, 0, 0}), Site::elsewhere);
}

TEST(Regions, call_nothing_a_table_beside_a_dry_skull) {
  const io::Volume skull = testdata::scan(testdata::make_shell(50, 57, testdata::bone_hu),
                                          testdata::make_geometry({.size = {128, 128, 60}}));
  const Regions regions(skull);
  EXPECT_EQ(regions.milliliters(Region::table), 0);
  EXPECT_GT(regions.milliliters(Region::body), 100);
}

/// A body that the scan cuts on all sides has no room about it: so none of its air is the room's.
TEST(Regions, find_no_room_within_a_body) {
  testdata::Phantom phantom = testdata::make_chest();
  const io::Volume inner = testdata::scan(
      phantom, testdata::make_geometry({.size = {60, 60, 40}, .spacing = {2, 2, 2}, .center = {-40, 0, 0}}),
      {.noise = 20});
  const Regions regions(inner);
  EXPECT_EQ(regions.milliliters(Region::room), 0);
  EXPECT_GT(regions.milliliters(Region::lung), 50);
}

/// The air that a path through air joins with the scan's left, right, front or back, on every second voxel of a fine
/// slice.
class FloodedRoom {
 public:
  explicit FloodedRoom(const io::Volume& volume)
      : volume_(volume),
        every_(volume.geometry.spacing_i < 1 ? glm::ivec3(2, 2, 1) : glm::ivec3(1)),
        size_((volume.geometry.dimensions + every_ - 1) / every_) {
    room_.resize(static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y) *
                 static_cast<std::size_t>(size_.z));
    for (int k = 0; k < size_.z; ++k) {
      for (int j = 0; j < size_.y; ++j) {
        for (int i = 0; i < size_.x; ++i) {
          const bool is_side = i == 0 || j == 0 || i + 1 == size_.x || j + 1 == size_.y;
          if (is_side || volume.is_padding(every_.x * i, every_.y * j, k)) reach(i, j, k);
        }
      }
    }
    while (!front_.empty()) {
      const glm::ivec3 at = front_.back();
      front_.pop_back();
      for (const int step : {-1, 1}) {
        reach(at.x + step, at.y, at.z);
        reach(at.x, at.y + step, at.z);
        reach(at.x, at.y, at.z + step);
      }
    }
  }
  bool has(const glm::ivec3& voxel) const {
    const glm::ivec3 at = voxel / every_;
    return is_in(at.x, at.y, at.z) && room_[offset(at.x, at.y, at.z)] != 0;
  }

 private:
  bool is_in(int i, int j, int k) const {
    return i >= 0 && j >= 0 && k >= 0 && i < size_.x && j < size_.y && k < size_.z;
  }
  std::size_t offset(int i, int j, int k) const {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(size_.y) + static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(size_.x) +
           static_cast<std::size_t>(i);
  }
  void reach(int i, int j, int k) {
    if (!is_in(i, j, k)) return;
    char& is_room = room_[offset(i, j, k)];
    if (is_room != 0 || !(volume_.value_at(every_.x * i, every_.y * j, k) < -300)) return;
    is_room = 1;
    front_.emplace_back(i, j, k);
  }

  const io::Volume& volume_;
  glm::ivec3 every_;
  glm::ivec3 size_;
  std::vector<char> room_;
  std::vector<glm::ivec3> front_;
};

/// Of the edges that a proposed scene calls skin: how many there are, and how many have no air of the room outside.
struct SkinContacts {
  std::size_t all = 0, without_room = 0;
};

SkinContacts skin_contacts(const std::shared_ptr<const io::Volume>& volume) {
  const Suggestion found = suggest(volume);
  const Regions regions(*volume);
  const FloodedRoom room(*volume);
  const double scale_mm = io::default_gradient_scale_mm(volume->geometry);
  const io::GradientKernel kernel(volume, scale_mm);
  const io::Geometry& g = volume->geometry;
  SkinContacts contacts;
  std::mutex adding;
  const auto look = [&](std::span<const io::CountedEdge> edges) {
    const std::scoped_lock lock(adding);
    for (const io::CountedEdge& edge : edges) {
      const double low = found.edges.values.middle(edge.low), high = found.edges.values.middle(edge.high);
      const auto is_its = [&](const FoundBoundary& b) {
        const Tissue &from = found.scene.tissues[b.low], &to = found.scene.tissues[b.high];
        return low >= from.low && low < from.high && high >= to.low && high < to.high;
      };
      const auto boundary = std::ranges::find_if(found.boundaries, is_its);
      if (boundary == found.boundaries.end()) continue;
      const Site site = site_of(regions.sides(g, edge.voxel, glm::dvec3(edge.gradient), reach_of_sides * scale_mm));
      if (name_at(found.scene.modes[boundary->mode].name, site) != "Skin") continue;
      ++contacts.all;
      const Vec3 at = g.to_patient(Vec3(edge.voxel)), out = -glm::normalize(glm::dvec3(edge.gradient));
      // The map's cells are 2.5 mm: the room's air may lie beside the way out.
      bool has_room = false;
      const glm::ivec3 around(glm::ceil(glm::dvec3(2.5 / g.spacing_i, 2.5 / g.spacing_j, 0)));
      for (double mm = 0; mm <= reach_of_sides * scale_mm + 2.5 && !has_room; mm += 0.5) {
        const glm::ivec3 middle(glm::round(g.to_index(at + mm * out)));
        for (int n = 0; n < 9 && !has_room; ++n) {
          has_room = room.has(middle + around * glm::ivec3(n % 3 - 1, n / 3 - 1, 0));
        }
      }
      if (!has_room) ++contacts.without_room;
    }
  };
  (void)io::low_high_histograms(*volume, kernel, found.edges.values, std::array{found.edges.values.width()}, {}, 0,
                                look);
  return contacts;
}

TEST(Regions, call_skin_of_a_chest_what_the_rooms_air_meets) {
  for (const ChestScan& chest_scan : chest_scans()) {
    // The test's flood would take head and feet of a coronal one for sides. The others differ in nothing that counts.
    if (chest_scan.name != "tilted" && chest_scan.name != "on the table") continue;
    const SkinContacts contacts = skin_contacts(std::make_shared<const io::Volume>(testdata::scan(
        chest(chest_scan.gap_mm), testdata::make_geometry(chest_scan.grid), {.noise = chest_scan.noise})));
    EXPECT_GT(contacts.all, 1000U) << chest_scan.name;
    EXPECT_EQ(contacts.without_room, 0U) << chest_scan.name << ", of " << contacts.all;
  }
}

class SharedRegions : public ::testing::TestWithParam<const char*> {};

TEST_P(SharedRegions, call_skin_what_the_rooms_air_meets) {
  const std::filesystem::path folder = std::filesystem::path(PALPATE_SHARED_DATA) / GetParam();
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "needs a shared CT, which is not at " << folder;
  if (is_sanitized) GTEST_SKIP() << "the phantoms run the same code";
  const io::Catalogue catalogue = io::find_series(std::array{folder});
  std::size_t all = 0;
  for (const io::Series& series : catalogue.series) {
    if (series.modality != "CT") continue;
    const auto volume = std::make_shared<const io::Volume>(io::load(series));
    if (volume->geometry.dimensions.z < 3 || volume->unit != "HU") continue;
    const SkinContacts contacts = skin_contacts(volume);
    EXPECT_EQ(contacts.without_room, 0U) << series.description << ", of " << contacts.all;
    all += contacts.all;
  }
  EXPECT_GT(all, 10000U);
}
INSTANTIATE_TEST_SUITE_P(Scans, SharedRegions,
                         ::testing::Values("ct_head_phantom_140", "structures/totalsegmentator/example_ct_dicom",
                                           "structures/dcmqi/ct-3slice", "mixed_folder_junk"));

}  // namespace
}  // namespace palpate::modes::internal
