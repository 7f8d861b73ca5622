#pragma once

/// Phantoms with known answers: solids painted over each other, each of one value. Patient space (LPS, mm), HU; all are
/// about the origin.

#include <span>
#include <vector>

#include "testdata/shape.h"

namespace palpate::testdata {

struct Body {
  Shape shape;
  double value = 0;
};

/// The value at a point is that of the last body that contains it, or the background's.
struct Phantom {
  double background = -1000;
  std::vector<Body> bodies;
};

double value_at(const Phantom& phantom, const Vec3& position_mm) noexcept;

/// Mean value over a voxel: the box spanned by three edges (mm) about a center. A curved surface is treated as planes
/// in parts so small that the fraction of a voxel on either side is wrong by less than 1e-4. Exact if one plane cuts
/// the voxel. If several surfaces meet in a voxel, accurate to 1/16 of its edges.
double mean_value(const Phantom& phantom, const Vec3& center_mm, const Vec3 (&edges)[3]);

/// Values of the tissues that phantoms are made of, HU.
inline constexpr double air_hu = -1000;
inline constexpr double soft_tissue_hu = 40;
inline constexpr double bone_hu = 1000;

struct Layer {
  double depth = 0;  ///< mm from the origin along the slab's inward direction
  double value = 0;  ///< from there on
};

/// Layers of ascending depth along `inward` (unit).
Phantom make_slab(const Vec3& inward, std::span<const Layer> layers, double background = air_hu);
Phantom make_sphere(double radius, double value = soft_tissue_hu, double background = air_hu);
/// A ball of `wall` with a concentric cavity of `lumen`: the cavity's wall is concave as seen from inside.
Phantom make_shell(double inner_radius, double outer_radius, double wall = soft_tissue_hu, double lumen = air_hu,
                   double background = air_hu);
/// A vessel: a straight tube of `lumen` through `background`, with its axis (unit) through the origin.
Phantom make_tube(double radius, const Vec3& axis, double lumen = 300, double background = soft_tissue_hu);
/// Two materials under one flat surface z = 0 (air above): `first` where z < 0 and the interface's normal . p > 0,
/// `second` on its other side. The interface leans by `angle_degrees` from the surface: 90 is upright.
Phantom make_wedge(double angle_degrees, double first = soft_tissue_hu, double second = bone_hu,
                   double background = air_hu);

/// A chest on a table, along z without end: a body of 160 mm radius about the z axis, its outer 10 mm fat, with two
/// lungs, a trachea, a spine and a heart. The table is a plate of 12 mm, 8 mm behind the body.
Phantom make_chest();
inline constexpr double fat_hu = -90, lung_hu = -850, table_hu = 150;

}  // namespace palpate::testdata
