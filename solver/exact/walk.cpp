#include "solver/exact/walk.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

namespace palpate::solver::internal {

namespace {

constexpr std::uint32_t none = ~std::uint32_t{0};

// Where along a way the energy is least: between these.
struct Bracket {
  double low = 0;
  double high = 1;
  double slope_low = 0;   // N m, just beyond low
  double slope_high = 0;  // N m, just before high

  void narrow(double at, double slope, bool falls) {
    (falls ? low : high) = at;
    (falls ? slope_low : slope_high) = slope;
  }
  // Where it is least were the slope a straight line, as a part of the width.
  double least() const {
    const double fall = std::max(0.0, -slope_low);
    const double rise = std::max(0.0, slope_high);
    return fall + rise > 0 ? std::clamp(fall / (fall + rise), 0.05, 0.95) : 0.5;
  }
  bool holds(double t) const { return t > low && t < high; }
  double width() const { return high - low; }
};

class Walker {
 public:
  Walker(Walk& walk, int cap) : walk_(walk), cap_(cap) {}

  int run();

 private:
  Local evaluate(const FineVec3& z, const ActiveSet& active);
  bool is_arrived(FineVec3& way);
  bool release(FineVec3& way);
  bool part(FineVec3& way);
  void advance(const FineVec3& way);
  bool lock_plane(const FineVec3& way, Bracket& bracket, double middle);
  std::uint32_t crossed_plane(const FineVec3& way, const Bracket& bracket, double& at) const;
  bool lock_attractor(const FineVec3& way, Bracket& bracket);
  bool lock_at(const ActiveSet& active, const FineVec3& near);

  Walk& walk_;
  int cap_;
  int looks_ = 0;
  Local here_;                     // at walk_.z
  double last_step_ = 0;           // m
  int still_ = 0;                  // steps that did not shrink
  std::uint32_t released_ = none;  // lets go of the proxy at the start of the way: not to be locked along it
};

Local Walker::evaluate(const FineVec3& z, const ActiveSet& active) {
  ++looks_;
  return internal::evaluate(walk_, z, active);
}

int Walker::run() {
  walk_.arrived = false;
  settle(walk_.active, walk_.primitives, walk_.z);
  here_ = evaluate(walk_.z, walk_.active);
  while (true) {
    FineVec3 way{};
    released_ = none;
    if (is_arrived(way)) {
      last_step_ = 0;
      still_ = 0;
      const bool crowded = here_.met > static_cast<std::size_t>(walk_.active.count);
      if (crowded ? !part(way) : !release(way)) {
        break;
      }
    }
    if (looks_ >= cap_ || !(glm::dot(here_.gradient, way.hi()) < 0)) {
      break;
    }
    advance(way);
  }
  return looks_;
}

double free_part(const ActiveSet& active, const Vec3& v) {
  if (active.rank == 3) {
    return 0;
  }
  if (active.rank == 2) {
    return std::abs(glm::dot(active.along.hi(), v));
  }
  const Vec3 n = active.normal[0].hi();
  return length_of(active.rank == 0 ? v : v - n * glm::dot(n, v));
}

// Whether this is the minimum on the flat, as far as rounding lets that be known; otherwise Newton's step to it. Where
// more is met than is locked the step says nothing.
bool Walker::is_arrived(FineVec3& way) {
  const ActiveSet& active = walk_.active;
  const double left = free_part(active, here_.gradient);
  if (here_.met > static_cast<std::size_t>(active.count) || left <= 2 * unit_roundoff * here_.size + here_.noise) {
    return true;
  }
  way = within(active, fine(newton_step(active, here_, walk_.stiffness)));
  const double step = length_of(way.hi());
  still_ = step > 0.5 * last_step_ && left <= 0x1p-40 * here_.size ? still_ + 1 : 0;
  last_step_ = step;
  return step <= 0x1p-100 * size_of(walk_.z) + 1e-55 || still_ > 2 || !(glm::dot(here_.gradient, way.hi()) < 0);
}

// Shares the force needed among what is locked; where one cannot exert its share it is let go, and the way found.
bool Walker::release(FineVec3& way) {
  ActiveSet& active = walk_.active;
  Vec3 forces[3];
  share(active, walk_.primitives, here_.gradient, forces);
  double worst = 16 * unit_roundoff * here_.size;
  int worst_index = -1;
  for (int j = 0; j < active.count; ++j) {
    const Placed& primitive = walk_.primitives[active.locked[j]];
    const double size =
        primitive.type == PrimitiveType::plane ? glm::dot(primitive.direction, forces[j]) : length_of(forces[j]);
    const double nearest = std::clamp(size, 0.0, primitive.strength);
    walk_.forces[active.locked[j]] = size == nearest || size == 0 ? forces[j] : forces[j] * (nearest / size);
    if (std::abs(size - nearest) > worst) {
      worst = std::abs(size - nearest);
      worst_index = j;
    }
  }
  if (worst_index < 0) {
    walk_.arrived = true;
    return false;
  }
  released_ = active.locked[worst_index];
  active = without(active, walk_.primitives, worst_index);
  here_.gradient -= walk_.forces[released_];
  const Placed& primitive = walk_.primitives[released_];
  if (primitive.type == PrimitiveType::plane) {
    way = within(active, fine(newton_step(active, here_, walk_.stiffness)));
    return true;
  }
  // The attractor's own curvature is infinite where it is left: the first step goes straight against its force, as far
  // as the others' curvature says.
  Vec3 direction = forces[worst_index] / -length_of(forces[worst_index]);
  if (active.rank == 1) {
    const Vec3 n = active.normal[0].hi();
    direction -= primitive.direction * (glm::dot(n, direction) / glm::dot(n, primitive.direction));
  }
  const double excess = -glm::dot(here_.gradient, direction);
  const double curvature = std::max(walk_.stiffness, glm::dot(direction, here_.hessian.times(direction)));
  way = within(active, fine(direction * (excess / curvature)));
  return true;
}

// The same where more primitives meet than are locked: all of them share the force needed; where they cannot, those
// that hold the proxy on its way to less energy are locked.
bool Walker::part(FineVec3& way) {
  const std::span<const std::uint32_t> met = walk_.met.first(here_.met);
  const Vec3 missing =
      share_out(walk_.primitives, met, here_.gradient, 4 * unit_roundoff * here_.size, walk_.forces, walk_.hold);
  const double size = length_of(missing);
  if (size == 0) {
    walk_.arrived = true;
    return false;
  }
  constexpr double aligned = 1e-5;
  walk_.active = {};
  Local rest = here_;
  for (const std::uint32_t i : met) {
    const Placed& primitive = walk_.primitives[i];
    const double along = std::abs(glm::dot(primitive.direction, missing));
    const bool stays = (primitive.type == PrimitiveType::plane && along <= aligned * size) ||
                       (primitive.type == PrimitiveType::line && along >= (1 - aligned) * size);
    if (!(stays && walk_.hold[i] == ForceRegion::held && lock(walk_.active, walk_.primitives, i))) {
      rest.gradient -= walk_.forces[i];
    }
  }
  way = within(walk_.active, fine(newton_step(walk_.active, rest, walk_.stiffness)));
  if (!(slope(walk_, here_, walk_.active, way) < 0)) {
    return false;
  }
  here_ = rest;
  return true;
}

// Goes along the way to where the energy is (about) least, or to what holds the proxy there.
void Walker::advance(const FineVec3& way) {
  const double start = glm::dot(here_.gradient, way.hi());
  Bracket bracket{.slope_low = start};
  double t = 1;
  FineVec3 there{};
  Local local;
  for (int tries = 0; tries < 60; ++tries) {
    there = walk_.z + way * t;
    settle(walk_.active, walk_.primitives, there);
    local = evaluate(there, walk_.active);
    const double slope_here = slope(walk_, local, walk_.active, way);
    double at = 0;
    const bool crossing = slope_here > 0 && crossed_plane(way, {bracket.low, t}, at) != none;
    // Beyond a kink the way falls less steeply than at its start: what may rise is measured by what fell last.
    const bool good =
        slope_here <= 0 ? t == 1 || slope_here >= 0.5 * start : !crossing && slope_here <= -0.3 * bracket.slope_low;
    if (good || looks_ >= cap_) {
      break;
    }
    bracket.narrow(t, slope_here, slope_here < 0);
    const double between = tries % 3 == 2 ? 0.5 : bracket.least();
    double width = 0;
    do {
      width = bracket.width();
      if (lock_plane(way, bracket, bracket.low + width * between)) {
        return;
      }
    } while (bracket.width() < width && looks_ < cap_);
    if (lock_attractor(way, bracket)) {
      return;
    }
    t = bracket.low + bracket.width() * between;
    if (!bracket.holds(t)) {
      t = bracket.low > 0 ? bracket.low : bracket.high;
      there = walk_.z + way * t;
      settle(walk_.active, walk_.primitives, there);
      local = evaluate(there, walk_.active);
      break;
    }
  }
  walk_.z = there;
  here_ = local;
}

// The plane, not locked, whose crossing in the bracket is nearest to `at`; then at is that crossing.
std::uint32_t Walker::crossed_plane(const FineVec3& way, const Bracket& bracket, double& at) const {
  std::uint32_t found = none;
  double best = 0;
  const Columns* const sorted = walk_.columns;
  const std::size_t end = sorted != nullptr ? sorted->attractors : walk_.primitives.size();
  for (std::size_t i = sorted != nullptr ? sorted->planes : 0; i < end; ++i) {
    const Placed& primitive = walk_.primitives[i];
    if (primitive.type != PrimitiveType::plane || i == released_ || walk_.active.has(i)) {
      continue;
    }
    const double t = -depth_of(primitive, walk_.z).value / rate_of(primitive, way);
    if (bracket.holds(t) && (found == none || std::abs(t - at) < std::abs(best - at))) {
      found = static_cast<std::uint32_t>(i);
      best = t;
    }
  }
  at = found == none ? at : best;
  return found;
}

// Narrows the place of the least energy by the crossing of a plane, or locks that plane. Neither where none is crossed.
bool Walker::lock_plane(const FineVec3& way, Bracket& bracket, double middle) {
  double at = middle;
  const std::uint32_t plane = crossed_plane(way, bracket, at);
  if (plane == none) {
    return false;
  }
  const Placed& primitive = walk_.primitives[plane];
  ActiveSet active = walk_.active;
  const bool independent = lock(active, walk_.primitives, plane);
  FineVec3 there = walk_.z + way * at;
  settle(active, walk_.primitives, there);
  const Local local = evaluate(there, active);
  const double rate = rate_of(primitive, way);
  const double others = slope(walk_, local, active, way) - (independent ? 0 : primitive.strength * std::max(0.0, rate));
  const double before = others + primitive.strength * std::min(0.0, rate);
  const double after = others + primitive.strength * std::max(0.0, rate);
  if (independent && before < 0) {
    // It holds the proxy where both of its sides drive towards it, though the way itself may lead on down.
    Vec3 forces[3];
    share(active, walk_.primitives, local.gradient, forces);
    const double asked = glm::dot(forces[active.count - 1], primitive.direction);
    if (after > 0 || (asked > 0 && asked < primitive.strength)) {
      walk_.active = active;
      walk_.z = there;
      here_ = local;
      return true;
    }
  }
  bracket.narrow(at, after <= 0 ? after : before, after <= 0);
  return false;
}

// Where the way passes an attractor that may hold the proxy against all others: tries whether it does.
bool Walker::lock_attractor(const FineVec3& way, Bracket& bracket) {
  const std::size_t begin = walk_.columns != nullptr ? walk_.columns->attractors : 0;
  for (auto i = static_cast<std::uint32_t>(begin); i < walk_.primitives.size(); ++i) {
    const Placed& primitive = walk_.primitives[i];
    if (primitive.type == PrimitiveType::directed_force || primitive.type == PrimitiveType::plane || i == released_ ||
        walk_.active.has(i)) {
      continue;
    }
    const Vec3& q = primitive.direction;
    const bool line = primitive.type == PrimitiveType::line;
    const Vec3 across = line ? way.hi() - q * glm::dot(q, way.hi()) : way.hi();
    const double speed = length_of(across);
    const Miss miss = walk_.columns != nullptr ? quick_miss_of(primitive, walk_.z) : miss_of(primitive, walk_.z);
    const double nearest = glm::dot(miss.vector.hi(), across) / (speed * speed);
    // Where primitives meet, one of them may have narrowed the bracket to that point.
    const double rounding = 1e-12 * nearest;
    if (!(nearest > bracket.low - rounding && nearest < bracket.high + rounding && nearest > 0)) {
      continue;
    }
    const FineVec3 there = walk_.z + way * nearest;
    const Local local = evaluate(there, walk_.active);
    const double slope_there = slope(walk_, local, walk_.active, way);
    if (walk_.primitives.size() <= 16 || std::abs(slope_there) <= primitive.strength * speed) {
      ActiveSet active;
      if (line && walk_.active.rank == 1) {
        lock(active, walk_.primitives, i);
        if (lock(active, walk_.primitives, walk_.active.locked[0]) && lock_at(active, there)) {
          return true;
        }
        active = {};
      }
      lock(active, walk_.primitives, i);
      if (lock_at(active, there)) {
        return true;
      }
    }
    if (bracket.holds(nearest)) {
      bracket.narrow(nearest, slope_there, slope_there < 0);
    }
  }
  return false;
}

// Locks what is in the active set, if the energy on it is less than here: by its slope there in the direction of here.
bool Walker::lock_at(const ActiveSet& active, const FineVec3& near) {
  FineVec3 there = near;
  settle(active, walk_.primitives, there);
  const Local local = evaluate(there, active);
  if (!(slope(walk_, local, {}, walk_.z - there) > 0)) {
    return false;
  }
  walk_.active = active;
  walk_.z = there;
  here_ = local;
  return true;
}

}  // namespace

int descend(Walk& walk, int cap) {
  return Walker(walk, cap).run();
}

}  // namespace palpate::solver::internal
