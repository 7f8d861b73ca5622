#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "io/fields/volume_fields.h"
#include "plugin/app/errors.h"
#include "plugin/app/vector_text.h"
#include "plugin/cli/commands.h"
#include "plugin/options/put.h"
#include "plugin/options/series_option.h"

namespace palpate::plugin {
namespace {

using Json = nlohmann::ordered_json;

struct SampleOptions {
  SeriesOption series;
  std::vector<std::string> at;
  double scale_mm = 0;
  bool json = false;
};

// Coordinates are typed and printed with a limited number of digits; a voxel's center is meant where one is that near.
glm::dvec3 at_nearby_center(const io::Geometry& geometry, const glm::dvec3& position) {
  constexpr double typed_digits = 1e-5;
  const glm::dvec3 index = geometry.to_index(position);
  const glm::dvec3 center = glm::round(index);
  return glm::length(index - center) < typed_digits ? geometry.to_patient(center) : position;
}

void run(const SampleOptions& options) {
  std::vector<glm::dvec3> points;
  for (const std::string& text : options.at) points.push_back(parse_vector(text, "--at"));

  const auto volume = std::make_shared<const io::Volume>(load_series(options.series));
  constexpr io::FieldSet wanted = io::FieldSet::value | io::FieldSet::gradient;
  const double scale = options.scale_mm > 0 ? options.scale_mm : io::default_gradient_scale_mm(volume->geometry);
  // Of a voxel its own value is asked for.
  const io::VolumeFields fields(volume, wanted, scale, {.value = io::ValueMethod::trilinear});

  Json all = Json::array();
  for (const glm::dvec3& point : points) {
    const io::Sample sample = fields.sample(at_nearby_center(volume->geometry, point), wanted);
    Json json;
    json["position_mm"] = {point.x, point.y, point.z};
    if (sample.inside) {
      json["value"] = sample.value;
      json["gradient_per_mm"] = {sample.gradient.x, sample.gradient.y, sample.gradient.z};
    } else {
      json["outside"] = true;
    }
    all.push_back(json);
    if (options.json) continue;
    put("({:.10g}, {:.10g}, {:.10g}) mm: ", point.x, point.y, point.z);
    if (!sample.inside) {
      put("outside the scan\n");
    } else {
      put("{:.10g}{}{}, gradient ({:.6g}, {:.6g}, {:.6g}) per mm\n", sample.value, volume->unit.empty() ? "" : " ",
          volume->unit, sample.gradient.x, sample.gradient.y, sample.gradient.z);
    }
  }
  if (options.json) put_json(all, 2);
}

}  // namespace

void add_sample(CLI::App& program) {
  CLI::App* command = program.add_subcommand(
      "sample",
      "Prints value and gradient at points in patient space.\n"
      "Values are interpolated linearly between the eight voxels around the point (trilinear). Gradients are computed\n"
      "at these voxels after a Gaussian blur (--scale), and interpolated in the same way.");
  const auto options = std::make_shared<SampleOptions>();
  add_series_option(*command, options->series);
  command->add_option("--at", options->at, "Points x,y,z in mm, patient space (LPS)")->required();
  command
      ->add_option("--scale", options->scale_mm,
                   "Scale of the gradient's Gaussian, mm; the default depends on the voxels")
      ->check(CLI::PositiveNumber);
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin
