#pragma once

/// Phase contrast: velocities measured along three directions, and their vector field.

#include <array>
#include <vector>

#include "io/dicom/series_source.h"
#include "io/load.h"
#include "io/series.h"

class DcmItem;

namespace palpate::io::internal {

/// The meaning of an image's stored values from its velocity encoding (direction: unit vector in patient space; venc:
/// cm/s). If the unit of the rescaled values (`rescale_unit`) is a velocity (cm/s, mm/s, m/s), the rescaled values are
/// used; otherwise the whole range of the stored bits stands for -venc to venc. Nothing for a magnitude image, or if
/// venc or direction is missing. Source: PS3.3 C.8.13.5.14, MR Velocity Encoding.
std::optional<VelocityEncoding> velocity_of(const std::vector<double>& direction, std::optional<double> venc,
                                            const std::string& rescale_unit, const Plane& plane,
                                            const PixelFormat& format);

/// The velocity encoding of a single-frame image: from the standard's attributes, or from Siemens' sequence name
/// (..._v150fh: 150 cm/s, feet to head), which also becomes the plane's label. No public document defines the sign of a
/// flow along these letters. The order of the letters is taken as the positive direction (here from feet to head), and
/// `header` gets a remark.
void read_classic_velocity(DcmItem& dataset, FileHeader& header, Plane& plane);

/// Joins series (or frames of one) of one study and grid that hold velocities along three independent directions,
/// equally many of each. Each time point becomes a frame.
std::vector<Series> join_velocities(const std::vector<Series>& series);

/// The vector field of one time point. `components` are the results of load() for each direction, m/s. Throws
/// DicomError if their grids differ.
Volume vector_field(std::array<Volume, 3> components, const std::array<Vec3, 3>& directions);

}  // namespace palpate::io::internal
