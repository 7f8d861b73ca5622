#pragma once

/// Inputs for the tests of the filters: a filter of each type, a scan with every oddity, and computed volumes.

#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "io/fields/filtered.h"
#include "testdata/scan.h"

namespace palpate::io {

inline const std::array<Filter, 4> filters{
    Filter{.type = find_filter_type("gaussian"), .sigma_mm = 1.3},
    Filter{.type = find_filter_type("median"), .width = 5},
    Filter{.type = find_filter_type("bilateral"), .sigma_mm = 1.5, .sigma_value = 60},
    Filter{.type = find_filter_type("non_local_means"), .sigma_value = 25}};

/// An uneven, tilted lattice with pixels that are not square, a gap, padding and noise.
inline std::shared_ptr<const Volume> odd_scan(double noise = 25) {
  testdata::Grid grid;
  grid.size = {41, 37, 40};
  grid.spacing = {0.7, 0.9, 1.4};
  grid.tilt_degrees = 12;
  grid.uneven_mm = 0.2;
  grid.missing = {17, 18};
  return std::make_shared<const Volume>(
      testdata::scan(testdata::make_sphere(11), testdata::make_geometry(grid), {.noise = noise, .circle_radius = 14}));
}

/// A volume of floats whose values are a function of the position in the patient.
template <typename F>
std::shared_ptr<const Volume> painted(const Geometry& geometry, const F& value) {
  Volume v;
  v.geometry = geometry;
  std::vector<float> voxels;
  for (int k = 0; k < geometry.dimensions.z; ++k) {
    for (int j = 0; j < geometry.dimensions.y; ++j) {
      for (int i = 0; i < geometry.dimensions.x; ++i) {
        voxels.push_back(static_cast<float>(value(geometry.to_patient({i, j, k}))));
      }
    }
  }
  v.voxels = std::move(voxels);
  return std::make_shared<const Volume>(std::move(v));
}

inline double at(const Volume& v, int i, int j, int k) {
  return v.value_at(i, j, k);
}

}  // namespace palpate::io
