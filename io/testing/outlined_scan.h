#pragma once

/// Scans on all types of grids, and shapes given by a formula, for tests that write and read outlines.

#include <filesystem>
#include <string>
#include <vector>

#include "io/series.h"
#include "io/structures/label_image.h"
#include "io/testing/test_image.h"

namespace palpate::io::testing {

/// The grid of a scan. Its images have 15 columns and 13 rows: odd, so that frames of bits begin within a byte.
struct ScanKind {
  static constexpr int columns = 15, rows = 13;
  std::string name;
  Vec3 direction_i{1, 0, 0}, direction_j{0, 1, 0};
  std::vector<Vec3> positions;
};

/// Axial, oblique, tilted, uneven, of one slice, feet first, and one whose slices are missing.
const std::vector<ScanKind>& scan_kinds();
const ScanKind& scan_kind(const std::string& name);

/// Writes a scan there and returns its series. The patient's name has letters outside ASCII, in Latin-1.
Series write_scan(const ScanKind& kind, const std::filesystem::path& folder);

struct Shape {
  std::string name;
  SignedDistance distance;
};

/// Around the middle of a scan: a ball, a shell with a ball in it, two balls, a ball over a corner.
std::vector<Shape> shapes_in(const Geometry& scan);

/// A label with all fields set, in letters outside ASCII.
StructureLabel full_label();

const WriteOptions by_test{.software_version = "1.2.3"};

}  // namespace palpate::io::testing
