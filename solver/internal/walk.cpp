#include "palpate/solver/internal/walk.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "palpate/solver/internal/symmetric.h"

namespace palpate::solver::internal {

namespace {

constexpr double unit_roundoff = 0x1p-53;
// m: nearer than this is on a primitive. It is nothing beside what any answer promises, and keeps products from
// underflowing.
constexpr double touch = 1e-50;

constexpr std::uint32_t none = ~std::uint32_t{0};

// The energy's smooth part about a point: that of everything which is not locked.
struct Local {
  Vec3 gradient{0};  // N
  Symmetric3 hessian{};
  double size = 0;      // N: the sum of the magnitudes that the gradient is made of
  double noise = 0;     // N: how wrong the gradient may be by the rounding of z
  std::size_t met = 0;  // primitives that z is on, locked or not
};

class Walker {
 public:
  Walker(Walk& state, int cap) : state_(state), cap_(cap) {}

  int run();

 private:
  double tolerance(const Placed& primitive, const FineVec3& z) const;
  void evaluate(const FineVec3& z, const Frame& frame, Local& local);
  double slope(const FineVec3& z, const Frame& frame, const FineVec3& way, std::uint32_t but = none);
  bool release(Local& local, FineVec3& way);
  bool part(Local& local, FineVec3& way);
  void advance(const FineVec3& way, double start, std::uint32_t released);
  bool lock_between(const FineVec3& way, double& low, double& high, double middle, std::uint32_t released);
  std::uint32_t crossed_plane(const FineVec3& way, double low, double high, std::uint32_t but, double& at) const;
  bool lock_attractor(const FineVec3& way, double& low, double& high, std::uint32_t released);
  bool lock_at(const Frame& frame, const FineVec3& near);

  Walk& state_;
  int cap_;
  int evaluations_ = 0;
};

Vec3 force_of_attractor(const Placed& attractor, const Miss& miss) {
  return miss.length > 0 ? miss.vector.hi() * (attractor.strength / miss.length) : Vec3{0};
}

double Walker::tolerance(const Placed& primitive, const FineVec3& z) const {
  return touch + state_.coarseness * (size_of(primitive.offset) + size_of(z));
}

void Walker::evaluate(const FineVec3& z, const Frame& frame, Local& local) {
  ++evaluations_;
  const double k = state_.stiffness;
  local.hessian = Symmetric3::identity(k);
  Vec3 sum = z.hi() * k - state_.pull;
  local.size = length_of(z.hi()) * k + length_of(state_.pull);
  local.noise = 0;
  local.met = 0;
  for (std::size_t i = 0; i < state_.primitives.size(); ++i) {
    const Placed& primitive = state_.primitives[i];
    if (primitive.type == PrimitiveType::directed_force) {
      continue;
    }
    if (frame.has(i)) {
      state_.met[local.met++] = static_cast<std::uint32_t>(i);
      continue;
    }
    const double s = primitive.strength;
    if (primitive.type == PrimitiveType::plane) {
      const Depth depth = depth_of(primitive, z);
      if (std::abs(depth.value) <= depth.error + tolerance(primitive, z)) {
        state_.met[local.met++] = static_cast<std::uint32_t>(i);
        continue;
      }
      const bool behind = depth.value > 0;
      state_.forces[i] = behind ? primitive.direction * s : Vec3{0};
      local.size += behind ? s : 0;
    } else {
      const Miss miss = miss_of(primitive, z);
      if (miss.length <= 4 * miss.error + tolerance(primitive, z)) {
        state_.met[local.met++] = static_cast<std::uint32_t>(i);
        continue;
      }
      const Vec3 along = miss.vector.hi() / miss.length;
      state_.forces[i] = along * s;
      local.size += s;
      local.noise += s * (miss.error / miss.length);
      const double curvature = s / miss.length;
      local.hessian.add_identity(curvature);
      local.hessian.add_dyad(along, -curvature);
      if (primitive.type == PrimitiveType::line) {
        local.hessian.add_dyad(primitive.direction, -curvature);
      }
    }
    sum -= state_.forces[i];
  }
  local.gradient = sum;
}

// The rate of a plane's depth along a way, in units of the depth.
double rate_of(const Placed& plane, const FineVec3& way) {
  const double rough = glm::dot(plane.direction, way.hi());
  if (std::abs(rough) > 0x1p-20 * size_of(way)) {
    return -rough;
  }
  return -dot(way, plane.given_direction).hi / plane.given_length;
}

// How fast a way leaves an attractor.
double speed_across(const Placed& attractor, const Vec3& way) {
  return length_of(
      attractor.type == PrimitiveType::line ? way - attractor.direction * glm::dot(attractor.direction, way) : way);
}

// dE/dt at z along the way, which is free for what is locked; without the contribution of `but`.
double Walker::slope(const FineVec3& z, const Frame& frame, const FineVec3& way, std::uint32_t but) {
  ++evaluations_;
  double sum = glm::dot(z.hi() * state_.stiffness - state_.pull, way.hi());
  for (std::size_t i = 0; i < state_.primitives.size(); ++i) {
    const Placed& primitive = state_.primitives[i];
    if (primitive.type == PrimitiveType::directed_force || i == but || frame.has(i)) {
      continue;
    }
    if (primitive.type == PrimitiveType::plane) {
      const Depth depth = depth_of(primitive, z);
      if (std::abs(depth.value) <= depth.error + tolerance(primitive, z)) {
        sum += primitive.strength * std::max(0.0, rate_of(primitive, way));
      } else if (depth.value > 0) {
        sum += primitive.strength * rate_of(primitive, way);
      }
    } else {
      const Miss miss = miss_of(primitive, z);
      if (miss.length <= 4 * miss.error + tolerance(primitive, z)) {
        sum += primitive.strength * speed_across(primitive, way.hi());
      } else {
        sum -= glm::dot(force_of_attractor(primitive, miss), way.hi());
      }
    }
  }
  return sum;
}

// Newton's step within the flat.
Vec3 newton_step(const Frame& frame, const Local& local, double stiffness) {
  const Symmetric3& hessian = local.hessian;
  const Vec3 wanted = -local.gradient;
  if (frame.rank == 0) {
    return hessian.solve(wanted, stiffness);
  }
  if (frame.rank == 2) {
    const Vec3 along = frame.along.hi();
    return along * (glm::dot(along, wanted) / std::max(stiffness, glm::dot(along, hessian.times(along))));
  }
  const Vec3 n = frame.normal[0].hi();
  const Vec3 u = glm::normalize(glm::cross(n, std::abs(n.x) < 0.6 ? Vec3{1, 0, 0} : Vec3{0, 1, 0}));
  const Vec3 v = glm::cross(n, u);
  const Vec3 hu = hessian.times(u);
  const double a = std::max(stiffness, glm::dot(u, hu));
  const double b = glm::dot(v, hu);
  const double l = b / a;
  const double d = std::max(stiffness, glm::dot(v, hessian.times(v)) - l * b);
  const double fu = glm::dot(u, wanted);
  const double y = (glm::dot(v, wanted) - l * fu) / d;
  return u * (fu / a - l * y) + v * y;
}

double free_size(const Frame& frame, const Vec3& v) {
  if (frame.rank == 3) {
    return 0;
  }
  if (frame.rank == 2) {
    return std::abs(glm::dot(frame.along.hi(), v));
  }
  return length_of(frame.rank == 0 ? v : v - frame.normal[0].hi() * glm::dot(frame.normal[0].hi(), v));
}

int Walker::run() {
  Local local;
  double last = 0;
  int still = 0;
  settle(state_.frame, state_.primitives, state_.z);
  while (evaluations_ < cap_) {
    evaluate(state_.z, state_.frame, local);
    FineVec3 way{};
    double length = 0;
    const bool crowded = local.met > static_cast<std::size_t>(state_.frame.count);
    bool arrived = state_.frame.rank == 3 || crowded ||
                   free_size(state_.frame, local.gradient) <= 2 * unit_roundoff * local.size + local.noise;
    if (!arrived) {
      way = within(state_.frame, fine(newton_step(state_.frame, local, state_.stiffness)));
      length = length_of(way.hi());
      arrived = length <= 0x1p-100 * size_of(state_.z) + 1e-5 * touch;
      // Where rounding is all that is left the steps no longer shrink.
      still = length > 0.5 * last && free_size(state_.frame, local.gradient) <= 0x1p-40 * local.size ? still + 1 : 0;
      arrived = arrived || still > 2 || !(glm::dot(local.gradient, way.hi()) < 0);
    }
    std::uint32_t released = none;
    if (arrived) {
      still = 0;
      last = 0;
      const Frame before = state_.frame;
      if (crowded ? !part(local, way) : !release(local, way)) {
        break;
      }
      for (int j = 0; j < before.count; ++j) {
        released = state_.frame.has(before.locked[j]) ? released : before.locked[j];
      }
    }
    last = length;
    const double start = glm::dot(local.gradient, way.hi());
    if (!(start < 0)) {
      break;
    }
    advance(way, start, released);
  }
  return evaluations_;
}

// Shares the force needed among what is locked; where one cannot exert its share it is let go, and the way found.
bool Walker::release(Local& local, FineVec3& way) {
  Frame& frame = state_.frame;
  Vec3 forces[3];
  share(frame, state_.primitives, local.gradient, forces);
  double worst = 0;
  int worst_index = -1;
  for (int j = 0; j < frame.count; ++j) {
    const std::uint32_t i = frame.locked[j];
    const Placed& primitive = state_.primitives[i];
    const double s = primitive.strength;
    const double size =
        primitive.type == PrimitiveType::plane ? glm::dot(primitive.direction, forces[j]) : length_of(forces[j]);
    const double excess = std::max(-size, size - s);
    const double nearest = std::max(0.0, std::min(s, size));
    state_.forces[i] = size == nearest || size == 0 ? forces[j] : forces[j] * (nearest / size);
    if (excess > 16 * unit_roundoff * local.size && excess > worst) {
      worst = excess;
      worst_index = j;
    }
  }
  if (worst_index < 0) {
    return false;
  }
  const std::uint32_t i = frame.locked[worst_index];
  const Placed& primitive = state_.primitives[i];
  const Vec3 asked = forces[worst_index];
  frame = without(frame, state_.primitives, worst_index);
  local.gradient -= state_.forces[i];
  if (primitive.type == PrimitiveType::plane) {
    way = within(frame, fine(newton_step(frame, local, state_.stiffness)));
    return true;
  }
  // The attractor's own curvature is infinite where it is left: the first step goes straight against its force, as far
  // as the others' curvature says.
  Vec3 direction = asked / -length_of(asked);
  if (frame.rank == 1) {
    const Vec3 n = frame.normal[0].hi();
    direction -= primitive.direction * (glm::dot(n, direction) / glm::dot(n, primitive.direction));
  }
  const double excess = -glm::dot(local.gradient, direction);
  const double curvature = std::max(state_.stiffness, glm::dot(direction, local.hessian.times(direction)));
  way = within(frame, fine(direction * (excess / curvature)));
  return true;
}

// The same where more primitives meet than are locked: all of them share the force needed; where they cannot, those
// that hold the proxy on its way to less energy are locked.
bool Walker::part(Local& local, FineVec3& way) {
  const std::span<const std::uint32_t> met = state_.met.first(local.met);
  const double tolerance = 4 * unit_roundoff * local.size;
  const Vec3 missing = share_out(state_.primitives, met, local.gradient, tolerance, state_.forces, state_.hold);
  const double size = length_of(missing);
  if (size <= tolerance) {
    return false;
  }
  state_.frame = {};
  for (const std::uint32_t i : met) {
    const Placed& primitive = state_.primitives[i];
    const double along = glm::dot(primitive.direction, missing);
    constexpr double aligned = 1e-5;
    if (state_.hold[i] != Hold::held) {
      continue;
    }
    if ((primitive.type == PrimitiveType::plane && std::abs(along) <= aligned * size) ||
        (primitive.type == PrimitiveType::line && std::abs(along) >= (1 - aligned) * size)) {
      lock(state_.frame, state_.primitives, i);
    }
  }
  for (const std::uint32_t i : met) {
    if (!state_.frame.has(i)) {
      local.gradient -= state_.forces[i];
    }
  }
  way = within(state_.frame, fine(newton_step(state_.frame, local, state_.stiffness)));
  return true;
}

// Goes along the way to where the energy is (about) least, or to what holds the proxy there.
void Walker::advance(const FineVec3& way, double start, std::uint32_t released) {
  double low = 0;
  double high = 1;
  double t = 1;
  double slope_low = start;
  double slope_high = 0;
  for (int tries = 0; tries < 60 && evaluations_ < cap_; ++tries) {
    const double here = slope(state_.z + way * t, state_.frame, way);
    double at = 0;
    const bool crossing = here > 0 && crossed_plane(way, low, t, released, at) != none;
    if (here <= 0 ? t == 1 || here >= 0.5 * start : !crossing && here <= -0.3 * start) {
      break;
    }
    if (here < 0) {
      low = t;
      slope_low = here;
    } else {
      high = t;
      slope_high = here;
    }
    const double between = tries % 3 == 2 ? 0.5 : std::clamp(slope_low / (slope_low - slope_high), 0.05, 0.95);
    while (true) {
      const double middle = low + (high - low) * between;
      const double width = high - low;
      if (lock_between(way, low, high, middle, released)) {
        return;
      }
      if (!(high - low < width) || evaluations_ >= cap_) {
        break;
      }
    }
    if (lock_attractor(way, low, high, released)) {
      return;
    }
    t = low + (high - low) * between;
    if (t <= low || t >= high) {
      t = low > 0 ? low : high;
      break;
    }
  }
  state_.z = state_.z + way * t;
  settle(state_.frame, state_.primitives, state_.z);
}

// The plane, not locked, that the way crosses between two places nearest to `at`.
std::uint32_t Walker::crossed_plane(const FineVec3& way, double low, double high, std::uint32_t but, double& at) const {
  std::uint32_t found = none;
  double best = 0;
  double nearest = 0;
  for (std::size_t i = 0; i < state_.primitives.size(); ++i) {
    const Placed& primitive = state_.primitives[i];
    if (primitive.type != PrimitiveType::plane || i == but || state_.frame.has(i)) {
      continue;
    }
    const double t = -depth_of(primitive, state_.z).value / rate_of(primitive, way);
    if (t > low && t < high && (found == none || std::abs(t - at) < nearest)) {
      found = static_cast<std::uint32_t>(i);
      best = t;
      nearest = std::abs(t - at);
    }
  }
  at = found == none ? at : best;
  return found;
}

// Narrows the place of the least energy by the crossing of a plane, or locks that plane. Neither where none is crossed.
bool Walker::lock_between(const FineVec3& way, double& low, double& high, double middle, std::uint32_t released) {
  double at = middle;
  const std::uint32_t plane = crossed_plane(way, low, high, released, at);
  if (plane == none) {
    return false;
  }
  const Placed& primitive = state_.primitives[plane];
  Frame frame = state_.frame;
  const bool independent = lock(frame, state_.primitives, plane);
  const FineVec3 there = state_.z + way * at;
  Local local;
  evaluate(there, frame, local);
  const double rate = rate_of(primitive, way);
  const double others = glm::dot(local.gradient, way.hi());
  const double push = primitive.strength * rate;
  const double before = others + (rate < 0 ? push : 0);
  const double after = others + (rate < 0 ? 0 : push);
  if (independent && before < 0) {
    // It holds the proxy where both of its sides drive towards it, though the way itself may lead on down.
    Vec3 forces[3];
    share(frame, state_.primitives, local.gradient, forces);
    const double asked = glm::dot(forces[frame.count - 1], primitive.direction);
    if (after > 0 || (asked > 0 && asked < primitive.strength)) {
      state_.frame = frame;
      state_.z = there;
      settle(state_.frame, state_.primitives, state_.z);
      return true;
    }
  }
  (after <= 0 ? low : high) = at;
  return false;
}

// Where the way passes an attractor that may hold the proxy against all others: tries whether it does.
bool Walker::lock_attractor(const FineVec3& way, double& low, double& high, std::uint32_t released) {
  for (std::size_t i = 0; i < state_.primitives.size(); ++i) {
    const Placed& primitive = state_.primitives[i];
    if (primitive.type == PrimitiveType::directed_force || primitive.type == PrimitiveType::plane ||
        state_.frame.has(i) || i == released) {
      continue;
    }
    Vec3 across = way.hi();
    if (primitive.type == PrimitiveType::line) {
      across -= primitive.direction * glm::dot(primitive.direction, across);
    }
    const double speed = length_of(across);
    const double nearest = glm::dot(miss_of(primitive, state_.z).vector.hi(), across) / (speed * speed);
    if (!(nearest > low && nearest < high)) {
      continue;
    }
    const FineVec3 there = state_.z + way * nearest;
    const double others = slope(there, state_.frame, way, static_cast<std::uint32_t>(i));
    if (std::abs(others) <= primitive.strength * speed) {
      const auto attractor = static_cast<std::uint32_t>(i);
      Frame frame;
      if (state_.frame.rank == 1 && primitive.type == PrimitiveType::line) {
        lock(frame, state_.primitives, attractor);
        if (lock(frame, state_.primitives, state_.frame.locked[0]) && lock_at(frame, there)) {
          return true;
        }
        frame = {};
      }
      lock(frame, state_.primitives, attractor);
      if (lock_at(frame, there)) {
        return true;
      }
    }
    (others < 0 ? low : high) = nearest;
  }
  return false;
}

// Locks what is in the frame, if the energy on it is less than here: by its slope there in the direction of here.
bool Walker::lock_at(const Frame& frame, const FineVec3& near) {
  FineVec3 there = near;
  settle(frame, state_.primitives, there);
  Local local;
  evaluate(there, frame, local);
  const FineVec3 back = state_.z - there;
  double rise = glm::dot(local.gradient, back.hi());
  for (const std::uint32_t i : state_.met.first(local.met)) {
    const Placed& primitive = state_.primitives[i];
    if (primitive.type == PrimitiveType::plane) {
      rise += primitive.strength * std::max(0.0, rate_of(primitive, back));
    } else {
      rise += primitive.strength * speed_across(primitive, back.hi());
    }
  }
  if (!(rise > 0)) {
    return false;
  }
  state_.frame = frame;
  state_.z = there;
  return true;
}

}  // namespace

int walk(Walk& state, int cap) {
  return Walker(state, cap).run();
}

}  // namespace palpate::solver::internal
