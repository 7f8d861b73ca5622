#include "solver/testing/reference.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace palpate::solver {

namespace {

__extension__ typedef __float128 Quad;

Quad root(Quad x) {
  if (!(x > 0)) {
    return 0;
  }
  // 64 bits from the processor, the rest from one step of Newton's method.
  const Quad near = std::sqrt(static_cast<long double>(x));
  return near > 0 ? (near + x / near) / 2 : 0;
}

struct QuadVec3 {
  Quad x = 0;
  Quad y = 0;
  Quad z = 0;
};

QuadVec3 wide(const Vec3& v) {
  return {v.x, v.y, v.z};
}
QuadVec3 operator+(const QuadVec3& a, const QuadVec3& b) {
  return {a.x + b.x, a.y + b.y, a.z + b.z};
}
QuadVec3 operator-(const QuadVec3& a, const QuadVec3& b) {
  return {a.x - b.x, a.y - b.y, a.z - b.z};
}
QuadVec3 operator*(const QuadVec3& a, Quad b) {
  return {a.x * b, a.y * b, a.z * b};
}
Quad dot(const QuadVec3& a, const QuadVec3& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
Quad length(const QuadVec3& a) {
  return root(dot(a, a));
}

// s |A (p - z)|, with A the projection along q (of a plane, whose other half is a constant force), across q, or
// neither.
struct Norm {
  PrimitiveType type;
  Quad strength;
  QuadVec3 position;
  QuadVec3 direction;
  QuadVec3 force;

  QuadVec3 project(const QuadVec3& v) const {
    if (type == PrimitiveType::point) {
      return v;
    }
    const QuadVec3 along = direction * dot(direction, v);
    return type == PrimitiveType::plane ? along : v - along;
  }
  QuadVec3 miss(const QuadVec3& z) const { return project(position - z); }
};

struct Problem128 {
  std::vector<Norm> norms;
  QuadVec3 pull;  // the constant forces
  Quad stiffness = 1;
  Quad size = 0;  // m

  QuadVec3 minus_gradient(const QuadVec3& z, Quad mu) const {
    QuadVec3 sum = pull - z * stiffness;
    for (const Norm& norm : norms) {
      const QuadVec3 m = norm.miss(z);
      sum = sum + m * (norm.strength / root(dot(m, m) + mu * mu));
    }
    return sum;
  }
};

Problem128 widen(const Balance& balance) {
  Problem128 problem;
  problem.stiffness = balance.stiffness;
  Quad force = 0;
  Quad reach = 0;
  for (const Primitive& primitive : balance.primitives) {
    force += std::isinf(primitive.strength) ? 0 : primitive.strength;
    if (primitive.type != PrimitiveType::directed_force) {
      reach = std::max(reach, length(wide(primitive.position) - wide(balance.probe)));
    }
  }
  const Quad hard = 1e6 * (force + problem.stiffness * reach) + 1e-300;
  for (const Primitive& primitive : balance.primitives) {
    QuadVec3 q = wide(primitive.direction);
    if (primitive.type != PrimitiveType::point) {
      q = q * (1 / length(q));
    }
    const Quad s = std::isinf(primitive.strength) ? hard : Quad(primitive.strength);
    if (primitive.type == PrimitiveType::directed_force) {
      problem.pull = problem.pull + q * s;
      continue;
    }
    const bool plane = primitive.type == PrimitiveType::plane;
    if (plane) {
      problem.pull = problem.pull + q * (s / 2);
    }
    if (s > 0) {
      problem.norms.push_back(
          {primitive.type, plane ? s / 2 : s, wide(primitive.position) - wide(balance.probe), q, {}});
    }
  }
  problem.size = reach + length(problem.pull) / problem.stiffness + 1e-300;
  return problem;
}

struct Matrix {
  Quad xx = 0, yy = 0, zz = 0, xy = 0, xz = 0, yz = 0;

  void add(const QuadVec3& a, const QuadVec3& b, Quad scale) {  // the symmetric part of a b^T
    xx += scale * a.x * b.x;
    yy += scale * a.y * b.y;
    zz += scale * a.z * b.z;
    xy += scale * (a.x * b.y + a.y * b.x) / 2;
    xz += scale * (a.x * b.z + a.z * b.x) / 2;
    yz += scale * (a.y * b.z + a.z * b.y) / 2;
  }
  QuadVec3 solve(const QuadVec3& b, Quad floor) const {
    const Quad d1 = std::max(xx, floor);
    const Quad l21 = xy / d1;
    const Quad l31 = xz / d1;
    const Quad d2 = std::max(yy - l21 * xy, floor);
    const Quad c32 = yz - l31 * xy;
    const Quad l32 = c32 / d2;
    const Quad d3 = std::max(zz - l31 * xz - l32 * c32, floor);
    const Quad y2 = b.y - l21 * b.x;
    const Quad x3 = (b.z - l31 * b.x - l32 * y2) / d3;
    const Quad x2 = y2 / d2 - l32 * x3;
    return {b.x / d1 - l21 * x2 - l31 * x3, x2, x3};
  }
};

Matrix hessian(const Problem128& problem, const QuadVec3& z, Quad mu) {
  Matrix matrix;
  matrix.xx = matrix.yy = matrix.zz = problem.stiffness;
  const QuadVec3 axes[] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  for (const Norm& norm : problem.norms) {
    const QuadVec3 m = norm.miss(z);
    const Quad smooth = root(dot(m, m) + mu * mu);
    for (const QuadVec3& axis : axes) {
      const QuadVec3 column = norm.project(axis);
      matrix.add(column, column, norm.strength / smooth);
    }
    matrix.add(norm.force, m, -1 / (smooth * smooth));
  }
  return matrix;
}

// The law of certify.h with the forces found, each inside its body.
double radius_at(const Problem128& problem, const QuadVec3& z) {
  QuadVec3 sum = problem.pull - z * problem.stiffness;
  Quad slack = 0;
  Quad size = length(problem.pull) + length(z) * problem.stiffness;
  Quad position = length(z);
  for (const Norm& norm : problem.norms) {
    const QuadVec3 m = norm.miss(z);
    const Quad reach = length(norm.position) + length(z);
    sum = sum + norm.force;
    slack += std::max(Quad(0), norm.strength * length(m) - dot(norm.force, m)) + 0x1p-108 * norm.strength * reach;
    size += norm.strength;
    position = std::max(position, reach);
  }
  const Quad r = (length(sum) + 0x1p-106 * size) / problem.stiffness;
  return static_cast<double>((r + root(r * r + 4 * slack / problem.stiffness)) / 2 + 0x1p-108 * position) *
         (1 + 0x1p-50);
}

// Onto what z is on but for the smoothing: to the position of a primitive, if one is near, else by alternating
// projections.
QuadVec3 snap(const Problem128& problem, QuadVec3 z, Quad near) {
  for (const Norm& norm : problem.norms) {
    if (length(norm.position - z) <= near) {
      return norm.position;
    }
  }
  for (int sweep = 0; sweep < 40; ++sweep) {
    for (const Norm& norm : problem.norms) {
      const QuadVec3 m = norm.miss(z);
      if (length(m) <= near) {
        z = z + m;
      }
    }
  }
  return z;
}

// Newton's step of the smoothed problem, for the place and for the forces; false where it no longer leads down.
bool step(Problem128& problem, QuadVec3& z, Quad mu, Quad& decrement) {
  const QuadVec3 wanted = problem.minus_gradient(z, mu);
  const QuadVec3 way = hessian(problem, z, mu).solve(wanted, problem.stiffness);
  decrement = dot(wanted, way);
  if (!(decrement > 0)) {
    return false;
  }
  Quad t = 1;
  for (int tries = 0; tries < 60 && dot(problem.minus_gradient(z + way * t, mu), way) < -0.5 * decrement; ++tries) {
    t *= 0.5;
  }
  for (Norm& norm : problem.norms) {
    const QuadVec3 m = norm.miss(z);
    const QuadVec3 change = norm.project(way);
    const Quad smooth = root(dot(m, m) + mu * mu);
    norm.force = ((m - change) * norm.strength + norm.force * (dot(m, change) / smooth)) * (1 / smooth);
    // Once more across or along the direction: what rounding added to the difference has been divided by mu.
    norm.force = norm.project(norm.force);
    const Quad size = length(norm.force);
    if (size > norm.strength) {
      norm.force = norm.force * (norm.strength / size * (1 - 0x1p-108));
    }
  }
  z = z + way * t;
  return true;
}

}  // namespace

Reference solve_reference(const Balance& balance) {
  Problem128 problem = widen(balance);
  QuadVec3 z = problem.pull * (1 / problem.stiffness);
  Reference best;
  best.radius = std::numeric_limits<double>::infinity();
  Quad strengths = 0;
  for (const Norm& norm : problem.norms) {
    strengths += norm.strength;
  }
  Quad mu = problem.size;
  int worse = 0;  // iterations since the radius shrank
  int here = 0;   // iterations with this mu
  const auto consider = [&](const QuadVec3& there) {
    const double radius = radius_at(problem, there);
    if (!(radius < best.radius)) {
      return;
    }
    worse = radius < 0.9 * best.radius ? 0 : worse;
    best.radius = radius;
    best.offset = {static_cast<double>(there.x), static_cast<double>(there.y), static_cast<double>(there.z)};
    const QuadVec3 rest = there - wide(best.offset);
    best.rest = {static_cast<double>(rest.x), static_cast<double>(rest.y), static_cast<double>(rest.z)};
  };
  while (best.iterations < 600 && worse < 60 && mu > 1e-40 * problem.size) {
    Quad decrement = 0;
    const bool moved = step(problem, z, mu, decrement);
    ++best.iterations;
    ++worse;
    consider(z);
    if (moved && decrement > 1e-8 * mu * strengths && ++here < 12) {
      continue;
    }
    here = 0;
    if (mu < 1e-10 * problem.size) {
      consider(snap(problem, z, 1e4 * mu));
    }
    if (best.radius < 1e-24 * static_cast<double>(problem.size)) {
      break;
    }
    mu *= 0.2;
  }
  return best;
}

double distance_to(const Reference& reference, const Balance& balance, const Vec3& proxy) {
  const QuadVec3 apart = wide(proxy) - wide(balance.probe) - wide(reference.offset) - wide(reference.rest);
  return static_cast<double>(length(apart)) * (1 + 0x1p-50);
}

}  // namespace palpate::solver
