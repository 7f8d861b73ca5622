#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include "io/errors.h"
#include "io/structures/compare_outlines.h"
#include "plugin/app/errors.h"
#include "plugin/cli/commands.h"
#include "plugin/cli/structure_option.h"
#include "plugin/messages/messages.h"
#include "plugin/options/put.h"

namespace palpate::plugin {
namespace {

struct CompareStructuresOptions {
  std::string first, second, to;
  bool json = false;
};

/// A structure that was read.
struct ReadOutline {
  io::Structure structure;
  double volume_mm3 = 0;
  io::ComparedOutline outline;
};

ReadOutline read_outline(const std::string& text) {
  ReadOutline read{.structure = choose_structure(text)};
  const io::StructureMeasures measures = io::measure(read.structure);
  read.volume_mm3 = measures.volume_mm3;
  read.outline.box = {measures.box_low_mm, measures.box_high_mm};
  io::DistanceOptions options;
  options.reach_mm = read.outline.true_to_mm + 1;
  read.outline.distance = [field = io::load_distance(read.structure, options)](const io::Vec3& at) {
    return field->sample(at).mm;
  };
  return read;
}

void check_same_frame(const ReadOutline& a, const ReadOutline& b) {
  const std::string &first = a.structure.frame_of_reference_uid, &second = b.structure.frame_of_reference_uid;
  if (first.empty() || second.empty() || first == second) return;
  throw InputRefused(say("structures-in-different-frames", a.structure.file.filename().string(),
                         b.structure.file.filename().string()));
}

void print(const ReadOutline& a, const ReadOutline& b, const io::OutlineComparison& found) {
  const io::Vec3& at = found.largest_at_mm;
  put("volume            {:.2f} ml and {:.2f} ml\n", a.volume_mm3 / 1000, b.volume_mm3 / 1000);
  put("Dice              {:.4f}\n", found.dice);
  put("surface distance  mean {:.2f} mm, 95 % within {:.2f} mm\n", found.mean_mm, found.p95_mm);
  put("largest           {:.2f} mm, at {:.1f}, {:.1f}, {:.1f} mm\n", found.largest_mm, at.x, at.y, at.z);
}

void run_compare_structures(const CompareStructuresOptions& options) try {
  const ReadOutline a = read_outline(options.first), b = read_outline(options.second);
  check_same_frame(a, b);
  std::optional<ReadOutline> to;
  if (!options.to.empty()) {
    to = read_outline(options.to);
    check_same_frame(b, *to);
  }
  const io::OutlineComparison found = io::compare_outlines(a.outline, b.outline);
  std::optional<double> margin_mm;
  if (to) margin_mm = io::margin_mm(b.outline, to->outline);
  if (options.json) {
    const io::Vec3& at = found.largest_at_mm;
    nlohmann::ordered_json json{{"volume_mm3", {a.volume_mm3, b.volume_mm3}},
                                {"dice", found.dice},
                                {"mean_mm", found.mean_mm},
                                {"p95_mm", found.p95_mm},
                                {"largest_mm", found.largest_mm},
                                {"largest_at_mm", {at.x, at.y, at.z}},
                                {"margin_mm", nullptr}};
    if (margin_mm) json["margin_mm"] = *margin_mm;
    put_json(json);
    return;
  }
  print(a, b, found);
  if (margin_mm) put("margin            {:.2f} mm from {} to {}\n", *margin_mm, b.structure.name, to->structure.name);
} catch (const io::DicomError& error) {
  throw InputRefused(error.text());
}

}  // namespace

void add_compare_structures(CLI::App& structures) {
  const auto options = std::make_shared<CompareStructuresOptions>();
  CLI::App* command =
      structures.add_subcommand("compare", "Measures how far apart two outlines are; their grids may differ");
  command->footer(
      "A, B, C: SEG, RTSTRUCT or label map; add :NUMBER or :NAME if it holds several structures.\n"
      "Compares the smooth surfaces that are felt, not the voxels. The center of each voxel\n"
      "of a structure lies inside its surface, and the centers of all other voxels lie outside.\n"
      "volume_mm3     of A and of B, as `palpate structures` lists it\n"
      "dice           twice the volume that both share, over the sum of both\n"
      "mean_mm        mean distance from the points of A's surface to the nearest point of B's, and from B's to A's,\n"
      "               weighted by area; the points are 0.2 to 2 mm apart, depending on the size\n"
      "p95_mm         95th percentile of these distances, weighted by area\n"
      "largest_mm     the largest of them (Hausdorff), found at largest_at_mm\n"
      "margin_mm      with --to: the smallest distance between the surfaces of B and C; below 0: how deep they "
      "overlap");
  command->add_option("A", options->first, "FILE or FILE:SEGMENT")->required();
  command->add_option("B", options->second, "FILE or FILE:SEGMENT")->required();
  command->add_option("--to", options->to, "Also print the margin from B to this structure");
  command->add_flag("--json", options->json, "Print JSON, in patient space (LPS, mm)");
  command->callback([options] { run_compare_structures(*options); });
}

}  // namespace palpate::plugin
