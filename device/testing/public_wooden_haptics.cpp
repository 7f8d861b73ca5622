#include "device/testing/public_wooden_haptics.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/mat3x3.hpp>
#include <glm/matrix.hpp>
#include <numbers>

namespace palpate::device {

namespace {

constexpr double ln = 0.080, lb = 0.205, lc = 0.245;  // m
constexpr double cpr = 2000;
constexpr double kt = 0.0259;            // N m/A
const Vec3 gear(0.160 / 0.010, 12, 12);  // body's diameter over its capstan's
const Vec3 origin(0.220, 0, 0.080);      // m, arm's frame: x towards the user, y right, z up
constexpr double turn = 2 * std::numbers::pi / cpr;

struct Pose {
  double a, b, c;
};

Pose pose_of(PublicHost host, const Vec3& counts) {
  if (host == PublicHost::haptikfabriken) {
    return {turn * counts.x / gear.x, turn * counts.y / gear.y, turn * counts.z / gear.z};
  }
  // The first encoder is turned round as it is read; the second gear ratio is negative; the third angle is measured
  // from the level, downwards.
  return {turn * -counts.x / gear.x, turn * counts.y / -gear.y, -(turn * counts.z / gear.z) + std::numbers::pi / 2};
}

Vec3 arm_from_device(const Vec3& v) {
  return {v.z, v.x, v.y};
}

}  // namespace

Vec3 public_wooden_position(PublicHost host, const Vec3& counts) {
  const Pose p = pose_of(host, counts);
  const double x = std::cos(p.a) * (lb * std::sin(p.b) + lc * std::sin(p.c)) - origin.x;
  const double y = std::sin(p.a) * (lb * std::sin(p.b) + lc * std::sin(p.c)) - origin.y;
  const double z = ln + lb * std::cos(p.b) - lc * std::cos(p.c) - origin.z;
  return {y, z, x};
}

Vec3 public_wooden_amperes(PublicHost host, const Vec3& counts, const Vec3& force) {
  const Pose p = pose_of(host, counts);
  const Vec3 f = arm_from_device(force);
  const double reach = lb * std::sin(p.b) + lc * std::sin(p.c);
  const double ta = -std::sin(p.a) * reach * f.x + std::cos(p.a) * reach * f.y;
  const double tb =
      lb * std::cos(p.a) * std::cos(p.b) * f.x + lb * std::sin(p.a) * std::cos(p.b) * f.y - lb * std::sin(p.b) * f.z;
  const double tc =
      lc * std::cos(p.a) * std::cos(p.c) * f.x + lc * std::sin(p.a) * std::cos(p.c) * f.y + lc * std::sin(p.c) * f.z;
  // The older host's board turns the second and third motor the other way.
  const double other = host == PublicHost::woody_2016 ? -1 : 1;
  return Vec3(ta / gear.x, other * tb / gear.y, other * tc / gear.z) / kt;
}

Vec3 public_wooden_counts(PublicHost host, const Vec3& position) {
  // The two links as a triangle, with the elbow as it is in the middle of the workspace: b near -10 degrees, c near
  // 100. In closed form: a search from the middle finds angles of other turns where an arm is folded.
  const Vec3 tip = arm_from_device(position) + origin - Vec3(0, 0, ln);
  const double out = std::hypot(tip.x, tip.y);
  const double distance = std::hypot(out, tip.z);
  const auto corner = [&](double beside, double opposite) {
    const double cosine = (distance * distance + beside * beside - opposite * opposite) / (2 * distance * beside);
    return std::acos(std::clamp(cosine, -1.0, 1.0));
  };
  const double direction = std::atan2(out, tip.z);
  const double a = std::atan2(tip.y, tip.x);
  const double b = direction - corner(lb, lc);
  const double c = std::numbers::pi - direction - corner(lc, lb);
  if (host == PublicHost::haptikfabriken) return gear * Vec3(a, b, c) / turn;
  return gear * Vec3(-a, -b, std::numbers::pi / 2 - c) / turn;
}

Vec3 public_wooden_force(PublicHost host, const Vec3& counts, const Vec3& amperes) {
  glm::dmat3 amperes_of_unit_forces;
  for (int axis = 0; axis < 3; ++axis) {
    Vec3 unit(0);
    unit[axis] = 1;
    amperes_of_unit_forces[axis] = public_wooden_amperes(host, counts, unit);
  }
  return glm::inverse(amperes_of_unit_forces) * amperes;
}

}  // namespace palpate::device
