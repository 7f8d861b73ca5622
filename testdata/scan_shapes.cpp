#include "testdata/scan_shapes.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <glm/geometric.hpp>
#include <limits>
#include <utility>

#include "testdata/scan.h"

namespace palpate::testdata {
namespace {

using Stored = std::vector<std::int16_t>;

constexpr double field_mm = 360;
constexpr std::int16_t padding_value = -2000;

Grid grid_of(const glm::ivec3& size) {
  return {.size = size, .spacing = {field_mm / size.x, field_mm / size.y, 1.25}};
}

/// Each voxel's value, given whether it lies in the shape: in parts of a slice's half side from its middle, and the
/// slice.
template <typename Voxels, typename Change>
void change_each(const glm::ivec3& size, Voxels& voxels, const Change& change) {
  auto voxel = voxels.begin();
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      for (int i = 0; i < size.x; ++i, ++voxel) {
        change(*voxel, glm::dvec2(2.0 * i / (size.x - 1) - 1, 2.0 * j / (size.y - 1) - 1), k);
      }
    }
  }
}

std::shared_ptr<io::Volume> copy_of(const io::Volume& plain) {
  return std::make_shared<io::Volume>(plain);
}

std::shared_ptr<const io::Volume> outside_circle(const io::Volume& plain, bool tagged) {
  auto volume = copy_of(plain);
  change_each(plain.geometry.dimensions, std::get<Stored>(volume->voxels), [](auto& voxel, const glm::dvec2& at, int) {
    if (glm::length(at) > 1) voxel = padding_value;
  });
  if (tagged) volume->padding = {padding_value, padding_value};
  return volume;
}

/// A disc that wanders from slice to slice, as what is cut out of a patient does, and voxels one by one.
std::shared_ptr<const io::Volume> padding_within(const io::Volume& plain) {
  auto volume = copy_of(plain);
  std::uint32_t random = 1;
  change_each(plain.geometry.dimensions, std::get<Stored>(volume->voxels),
              [&](auto& voxel, const glm::dvec2& at, int k) {
                random = random * 1664525 + 1013904223;
                const glm::dvec2 middle(0.3 * std::sin(0.1 * k), 0.3 * std::cos(0.07 * k));
                if (glm::length(at - middle) < 0.15 || random < 20000) voxel = padding_value;
              });
  volume->padding = {padding_value, padding_value};
  return volume;
}

std::shared_ptr<const io::Volume> on_grid(const io::Volume& plain, double tilt_degrees, double uneven_mm) {
  auto volume = copy_of(plain);
  Grid grid = grid_of(plain.geometry.dimensions);
  grid.tilt_degrees = tilt_degrees;
  grid.uneven_mm = uneven_mm;
  volume->geometry = make_geometry(grid);
  return volume;
}

std::shared_ptr<const io::Volume> as_floats(const io::Volume& plain, bool with_nan) {
  auto volume = copy_of(plain);
  const auto& stored = std::get<Stored>(plain.voxels);
  std::vector<float> values(stored.size());
  std::ranges::transform(stored, values.begin(),
                         [&](std::int16_t one) { return static_cast<float>(plain.slope * one + plain.intercept); });
  if (with_nan) {
    change_each(plain.geometry.dimensions, values, [](float& value, const glm::dvec2& at, int) {
      if (glm::length(at) > 1) value = std::numeric_limits<float>::quiet_NaN();
    });
  }
  volume->voxels = std::move(values);
  volume->slope = 1;
  volume->intercept = 0;
  return volume;
}

std::shared_ptr<const io::Volume> of_8_bits(const io::Volume& plain) {
  auto volume = copy_of(plain);
  constexpr double step = 10;
  const auto& stored = std::get<Stored>(plain.voxels);
  std::vector<std::uint16_t> values(stored.size());
  std::ranges::transform(stored, values.begin(), [&](std::int16_t one) {
    return static_cast<std::uint16_t>(std::clamp((plain.slope * one + plain.intercept + 1024) / step, 0.0, 255.0));
  });
  volume->voxels = std::move(values);
  volume->slope = step;
  volume->intercept = -1024;
  return volume;
}

/// Tissues a few hundred apart under noise and a shading, and a few bright vessels that reach to 30 000.
std::shared_ptr<const io::Volume> wide_mr(const io::Volume& plain) {
  auto volume = copy_of(plain);
  change_each(plain.geometry.dimensions, std::get<Stored>(volume->voxels),
              [](auto& voxel, const glm::dvec2& at, int k) {
                const double tissue = 200 + 0.3 * voxel;
                const bool in_vessel = glm::length(at - glm::dvec2(0.2 + 0.002 * k, 0.1)) < 0.02;
                voxel = static_cast<std::int16_t>(in_vessel ? 30000 : tissue * (1 + 0.3 * at.x) + voxel % 7);
              });
  volume->slope = 1;
  volume->intercept = 0;
  volume->unit.clear();
  volume->modality = "MR";
  return volume;
}

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

}  // namespace

std::shared_ptr<const io::Volume> plain_chest(const glm::ivec3& size) {
  constexpr int scanned = 8;  // to scan all of them would take longer than what is measured
  const glm::ivec3 part(size.x, size.y, std::min(size.z, scanned));
  auto volume = std::make_shared<io::Volume>(scan(make_chest(), make_geometry(grid_of(part)), {.noise = 20}));
  const Stored some = std::get<Stored>(volume->voxels);
  auto& all = std::get<Stored>(volume->voxels);
  all.resize(volume->offset(0, 0, size.z));
  for (std::size_t n = some.size(); n < all.size(); ++n) all[n] = some[n % some.size()];
  volume->geometry = make_geometry(grid_of(size));
  return volume;
}

const std::vector<ScanShape>& scan_shapes() {
  static const std::vector<ScanShape> shapes{
      {"padding outside a circle", [](const io::Volume& plain) { return outside_circle(plain, true); }},
      {"the same, not said to be padding", [](const io::Volume& plain) { return outside_circle(plain, false); }},
      {"padding within", padding_within},
      {"uneven slices", [](const io::Volume& plain) { return on_grid(plain, 0, 0.2); }},
      {"slices tilted by 20 degrees", [](const io::Volume& plain) { return on_grid(plain, 20, 0); }},
      {"floats", [](const io::Volume& plain) { return as_floats(plain, false); }},
      {"floats, NaN outside a circle", [](const io::Volume& plain) { return as_floats(plain, true); }},
      {"8 bits", of_8_bits},
      {"MR of wide range and low contrast", wide_mr}};
  return shapes;
}

CostRatio compare_costs(int rounds, const std::function<void()>& plain, const std::function<void()>& shape) {
  CostRatio least{std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
  const auto once = [](const std::function<void()>& work, double& seconds) {
    const double start = processor_seconds();
    work();
    seconds = std::min(seconds, processor_seconds() - start);
  };
  for (int round = 0; round < rounds; ++round) {
    once(plain, least.plain_s);
    once(shape, least.shape_s);
  }
  return least;
}

}  // namespace palpate::testdata
