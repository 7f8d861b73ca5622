// scan_edge on real organs: at the doubtful places of the shared CT's outlines.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <filesystem>
#include <glm/geometric.hpp>
#include <string>

#include "io/load.h"
#include "io/structures/doubtful_places.h"
#include "io/structures/edits.h"
#include "io/structures/outline_parts.h"
#include "io/structures/structure.h"
#include "solver/text/message.h"

namespace palpate::io {
namespace {

namespace fs = std::filesystem;
const fs::path example = fs::path(PALPATE_SHARED_DATA) / "structures" / "totalsegmentator";
constexpr std::size_t most_places = 10;

TEST(SharedScanEdge, IsTakenAtTheDoubtfulPlacesOfRealOrgans) {
  if (!fs::exists(example)) GTEST_SKIP() << "needs the shared structures, which are not beside this checkout";
  const auto scan =
      std::make_shared<const Volume>(load(find_series(std::array{example / "example_ct_dicom"}).series.at(0)));
  const auto fields = edge_fields(scan);
  const ScanValues values{*fields, scan->geometry};
  DistanceOptions near;
  near.scan = &scan->geometry;
  near.reach_mm = doubt_within_mm;
  std::size_t accepted = 0, asked = 0, moved = 0;
  for (const Structure& organ : find_structures(std::array{example / "example_seg_dicom.nii.gz"}).structures) {
    if (organ.name != "liver" && organ.name != "spleen" && organ.name != "stomach" && organ.name != "aorta") continue;
    const auto outline = load_distance(organ, near);
    const auto parts = outline_parts(*outline);
    std::size_t of_organ = 0, done = 0;
    for (const DoubtfulPlace& place : doubtful_places(values, *outline).places) {
      if (place.kind != DoubtKind::edge || of_organ == most_places) continue;
      const double radius = std::array{10.0, 12.0, 15.0}.at(of_organ % 3);
      const ScanEdgeEdit edit{.center_mm = place.position_mm, .radius_mm = radius, .most_mm = 0.4 * radius};
      ++of_organ;
      try {
        EditOutcome outcome;
        const auto after = apply_edit(outline, edit, {.scan = &values}, &outcome);
        ++done;
        moved += outcome.largest_mm > 0.5 ? 1 : 0;
        std::printf(
            "%s %zu: by %.2f mm at most; %zu places, %zu without an edge, %zu held back; at the middle %.2f of %.2f\n",
            organ.name.c_str(), of_organ, outcome.largest_mm, outcome.points, outcome.without_edge, outcome.held_back,
            after->sample(place.position_mm).mm, place.mean_mm);
        EXPECT_LE(outcome.largest_mm, edit.most_mm);
        EXPECT_EQ(outline_parts(*after).size(), parts.size()) << organ.name << " " << of_organ;
      } catch (const InvalidInput& error) {
        std::printf("%s %zu: %s\n", organ.name.c_str(), of_organ, error.what());
      }
    }
    std::printf("%s: %zu of %zu accepted\n", organ.name.c_str(), done, of_organ);
    accepted += done;
    asked += of_organ;
  }
  EXPECT_GT(asked, 15U);
  EXPECT_EQ(accepted, asked);
  EXPECT_GT(2 * moved, asked) << "it moves at most of them";
}

}  // namespace
}  // namespace palpate::io
