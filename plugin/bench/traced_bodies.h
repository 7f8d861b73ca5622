#pragma once

/// Bodies with known edges, outlined correctly or wrongly, and their scans, to be traced by a simulated hand.

#include <functional>
#include <glm/vec3.hpp>
#include <memory>

#include "io/structures/distance_field.h"
#include "io/volume.h"
#include "testdata/phantom.h"

namespace palpate::plugin {

using OutlineMm = std::function<double(const glm::dvec3&)>;  ///< signed distance, mm, positive inside

/// The outline of a body as a label map on a lattice represents it.
std::shared_ptr<const io::DistanceField> outline_of(const io::Geometry& lattice, const OutlineMm& mm, double reach_mm);

/// A scan with the blur (0.6 mm) and noise (12 HU) of a soft kernel.
std::shared_ptr<const io::Volume> soft_scan(const testdata::Phantom& phantom, const io::Geometry& geometry);

}  // namespace palpate::plugin
