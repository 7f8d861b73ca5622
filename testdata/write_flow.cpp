#include "testdata/write_flow.h"

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <glm/geometric.hpp>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/fresh_folder.h"
#include "testdata/write_series.h"

namespace palpate::testdata {
namespace {

constexpr std::uint16_t padding = 4095;
constexpr double half_range = 2048;  // stored values from 0: 12 bits

struct Measured {
  const char* name;
  Vec3 direction;
};
constexpr Measured directions[] = {
    {"right to left", {1, 0, 0}}, {"front to back", {0, 1, 0}}, {"feet to head", {0, 0, 1}}};

io::Volume empty_volume(const io::Geometry& geometry) {
  io::Volume volume;
  volume.geometry = geometry;
  volume.modality = "MR";
  volume.padding = {padding, padding};
  return volume;
}

/// What `store` makes of the flow at each voxel; padding where there is none.
template <typename Store>
io::Volume measure(const FlowSource& flow, const io::Geometry& geometry, const Store& store) {
  io::Volume volume = empty_volume(geometry);
  std::vector<std::uint16_t> voxels;
  const glm::ivec3 size = geometry.dimensions;
  voxels.reserve(volume.offset(0, 0, size.z));
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i) {
        const io::Sample sample = flow.sample(geometry.to_patient({i, j, k}), io::FieldSet::vector);
        voxels.push_back(sample.inside ? store(sample.vector) : padding);
      }
    }
  }
  volume.voxels = std::move(voxels);
  return volume;
}

std::string numbered(const char* name, int number) {
  char text[32];
  std::snprintf(text, sizeof text, "%s_%02d", name, number);
  return text;
}

}  // namespace

Vec3 free_stream_at(const FlowStudy& study, int time) {
  const double phase = 2 * std::numbers::pi * time / study.times;
  return (1 + study.pulsation * std::sin(phase)) * study.flow.free_stream;
}

double fastest_cm_per_s(const FlowStudy& study) {
  // Potential flow is fastest at the sphere's equator: 1.5 times the free stream.
  constexpr double fastest = 1.5;
  constexpr double cm_per_m = 100;
  return fastest * cm_per_m * (1 + std::abs(study.pulsation)) * glm::length(study.flow.free_stream);
}

void write_flow_study(const FlowStudy& study, const std::filesystem::path& folder) {
  const double fastest = fastest_cm_per_s(study);
  const double venc = study.venc_cm_per_s > 0 ? study.venc_cm_per_s : 1.2 * fastest;
  if (study.times < 1 || venc < fastest) {
    throw std::invalid_argument("a flow study needs at least one time and a venc above its fastest speed");
  }
  const io::Geometry geometry = make_geometry(study.grid);
  io::FreshFolder fresh(folder);
  SeriesLabel label{
      .description = "", .subject = "PHANTOM", .bits_stored = 12, .modality = "MR", .study = "palpate 4D flow"};
  for (int time = 0; time < study.times; ++time) {
    FlowPastSphere now = study.flow;
    now.free_stream = free_stream_at(study, time);
    const FlowSource flow(now);
    label.trigger_time_ms = study.cycle_ms * time / study.times;

    label.number = 1;
    label.description = "4D flow magnitude";
    label.phase_contrast.reset();
    constexpr std::uint16_t bright = 1000;
    write_series(measure(flow, geometry, [](const Vec3&) { return bright; }),
                 fresh.path() / "magnitude" / numbered("time", time), label);

    for (const auto& [name, direction] : directions) {
      ++label.number;
      label.description = std::string("4D flow ") + name;
      label.phase_contrast = PhaseContrast{direction, venc};
      io::Volume volume = measure(flow, geometry, [&, along = direction](const Vec3& velocity) {
        constexpr double cm_per_m = 100;
        return static_cast<std::uint16_t>(
            std::lround(half_range + half_range * cm_per_m * glm::dot(velocity, along) / venc));
      });
      volume.slope = 2;
      volume.intercept = -2 * half_range;
      write_series(volume, fresh.path() / numbered("velocity", label.number - 1) / numbered("time", time), label);
    }
  }
  fresh.commit();
}

}  // namespace palpate::testdata
