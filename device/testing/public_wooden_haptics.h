#pragma once

/// A WoodenHaptics arm as in its makers' host programs, written independently of the driver's, so that a wrong sign or
/// scale in the driver shows on the fake: CWoodenDevice.cpp of woody-experimental (with firmware of 2016, reports of 8
/// bytes) and kinematics.cpp of haptikfabrikenapi (with its configuration woodenhaptics_v2015).

#include <array>

#include "device/stylus.h"

namespace palpate::device {

enum class PublicHost { woody_2016, haptikfabriken };

/// m, in the device's frame (x right, y up, z towards the user).
Vec3 public_wooden_position(PublicHost host, const Vec3& counts);
/// Currents of the three motors (A) for a force (N, device's frame).
Vec3 public_wooden_amperes(PublicHost host, const Vec3& counts, const Vec3& force);
/// The counts, not rounded, of a position: the inverse of public_wooden_position(), on the arm's own branch.
Vec3 public_wooden_counts(PublicHost host, const Vec3& position);
/// Force (N, device's frame) for motor currents.
Vec3 public_wooden_force(PublicHost host, const Vec3& counts, const Vec3& amperes);

}  // namespace palpate::device
