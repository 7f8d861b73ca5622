#pragma once

/// Phase contrast: velocities measured along three directions, and the vector field that they make together.

#include <array>
#include <vector>

#include "io/dicom/series_source.h"
#include "io/load.h"
#include "io/series.h"

class DcmItem;

namespace palpate::io::internal {

/// What an image's velocity encoding (direction, unit vector in patient space; venc, cm/s) says of its stored values.
/// Where the rescaled values are velocities by their unit (`rescale_unit`: cm/s, mm/s, m/s) that counts; otherwise the
/// whole range of the stored bits stands for -venc to venc. Nothing for a magnitude image, or where venc or direction
/// is missing. Source: PS3.3 C.8.13.5.14, MR Velocity Encoding.
std::optional<VelocityEncoding> velocity_of(const std::vector<double>& direction, std::optional<double> venc,
                                            const std::string& rescale_unit, const Plane& plane,
                                            const PixelFormat& format);

/// The velocity encoding of a single-frame image: by the standard's attributes, or by the sequence's name as Siemens
/// writes it (..._v150fh: 150 cm/s, feet to head), which also becomes the plane's label. No public document says which
/// sign Siemens gives to a flow along these letters: it is taken as they read, and `header` remarks on it.
void read_classic_velocity(DcmItem& dataset, FileHeader& header, Plane& plane);

/// Series (or frames of one) of one study and one grid that hold velocities along three independent directions, as
/// often each, joined: one frame a time.
std::vector<Series> join_velocities(const std::vector<Series>& series);

/// The vector field of one time: `components` are what load() gives of each direction, in m/s. Throws DicomError where
/// they do not lie on one grid.
Volume vector_field(std::array<Volume, 3> components, const std::array<Vec3, 3>& directions);

}  // namespace palpate::io::internal
