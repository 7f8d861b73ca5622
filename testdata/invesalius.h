#pragma once

/// Debian's invesalius-examples: a real head CT as an InVesalius project, a gzipped tar.

#include <filesystem>

#include "io/volume.h"

namespace palpate::testdata {

/// Where the package puts its head CT.
inline constexpr const char* invesalius_cranium = "/usr/share/doc/invesalius-examples/examples/Cranium.inv3";

/// Reads the CT of an InVesalius project, centered at the origin. Its rows come bottom-up and its slices from the jaw
/// upwards: rows are flipped, so that j runs to the back and k to the head. The file does not say which side is left;
/// it is assumed to be as in DICOM.
///
/// Throws std::runtime_error naming the file for anything but an axial int16 CT.
io::Volume read_invesalius(const std::filesystem::path& file);

}  // namespace palpate::testdata
