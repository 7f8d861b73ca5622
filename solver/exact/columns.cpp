#include "solver/exact/columns.h"

#include <algorithm>
#include <cmath>

#include "solver/exact/for_processor.h"

namespace palpate::solver::internal {

namespace {

constexpr std::size_t at_once = 64;
constexpr std::size_t lanes = 4;  // sums side by side

// What some primitives do: zero where they are too near.
struct Chunk {
  double x[at_once], y[at_once], z[at_once];  // force, N
  double tx[at_once], ty[at_once], tz[at_once];
  double curvature[at_once];
  double size[at_once], noise[at_once];
  double far[at_once];  // 1 or 0: as wide as the others, so that GCC vectorizes the loop
};

PALPATE_SIDE_BY_SIDE
void look_at_planes(const Columns& c, std::size_t begin, std::size_t count, const FineVec3& z, double coarseness,
                    double touch, Chunk& __restrict chunk) {
  const Vec3 at = z.hi();
  const double size_of_z = size_of(z);
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t i = begin + n;
    const double depth = (c.x[i] - at.x) * c.qx[i] + (c.y[i] - at.y) * c.qy[i] + (c.z[i] - at.z) * c.qz[i];
    const double size = c.size[i] + size_of_z;
    const double error = rough_rounding * size;
    // One comparison, so that GCC vectorizes the loop.
    const bool far = std::abs(depth) > std::max(0x1p20 * error, error + touch + coarseness * size);
    const double full = depth > 0 ? c.strength[i] : 0.0;
    const double strength = far ? full : 0.0;
    chunk.far[n] = far ? 1 : 0;
    chunk.size[n] = strength;
    chunk.x[n] = c.qx[i] * strength;
    chunk.y[n] = c.qy[i] * strength;
    chunk.z[n] = c.qz[i] * strength;
  }
}

// As quick_miss_of().
PALPATE_SIDE_BY_SIDE
void look_at_attractors(const Columns& c, std::size_t begin, std::size_t count, const FineVec3& z, double coarseness,
                        double touch, Chunk& __restrict chunk) {
  const double size_of_z = size_of(z);
  for (std::size_t n = 0; n < count; ++n) {
    const std::size_t i = begin + n;
    const double ex = (c.x[i] - z.x.hi) + (c.x_low[i] - z.x.lo);
    const double ey = (c.y[i] - z.y.hi) + (c.y_low[i] - z.y.lo);
    const double ez = (c.z[i] - z.z.hi) + (c.z_low[i] - z.z.lo);
    const double along = c.qx[i] * ex + c.qy[i] * ey + c.qz[i] * ez;
    const double mx = ex - c.qx[i] * along;
    const double my = ey - c.qy[i] * along;
    const double mz = ez - c.qz[i] * along;
    const double squared = mx * mx + my * my + mz * mz;
    const double length = std::sqrt(squared);
    const double distance = std::abs(ex) + std::abs(ey) + std::abs(ez);
    const double error = quick_rounding * distance;
    const double reach = touch + coarseness * (c.size[i] + size_of_z);
    // One comparison, so that GCC vectorizes the loop.
    const double in_range = std::min(squared - 1e-280, 1e280 - squared);
    const double beyond = std::min(length - quick_part * distance, length - (4 * error + reach));
    const bool far = std::min(in_range, beyond) > 0;
    const double full = c.strength[i];
    const double strength = far ? full : 0;
    const double inverse = 1 / (far ? length : 1.0);
    chunk.far[n] = far ? 1 : 0;
    chunk.tx[n] = mx * inverse;
    chunk.ty[n] = my * inverse;
    chunk.tz[n] = mz * inverse;
    chunk.x[n] = chunk.tx[n] * strength;
    chunk.y[n] = chunk.ty[n] * strength;
    chunk.z[n] = chunk.tz[n] * strength;
    chunk.size[n] = strength;
    chunk.curvature[n] = strength * inverse;
    chunk.noise[n] = error * chunk.curvature[n];
  }
}

double sum_of(const double (&lane)[lanes]) {
  return (lane[0] + lane[1]) + (lane[2] + lane[3]);
}

PALPATE_SIDE_BY_SIDE
void add_forces(const Chunk& chunk, std::size_t count, Sums& sums) {
  double x[lanes]{}, y[lanes]{}, z[lanes]{}, size[lanes]{};
  for (std::size_t n = 0; n < count; n += lanes) {
    for (std::size_t l = 0; l < lanes; ++l) {
      x[l] += chunk.x[n + l];
      y[l] += chunk.y[n + l];
      z[l] += chunk.z[n + l];
      size[l] += chunk.size[n + l];
    }
  }
  sums.force += Vec3{sum_of(x), sum_of(y), sum_of(z)};
  sums.size += sum_of(size);
}

// c (1 - q q^T - t t^T): across a line, and across the direction to it.
PALPATE_SIDE_BY_SIDE
void add_curvatures(const Columns& c, std::size_t begin, const Chunk& chunk, std::size_t count, Sums& sums) {
  double xx[lanes]{}, yy[lanes]{}, zz[lanes]{}, xy[lanes]{}, xz[lanes]{}, yz[lanes]{}, noise[lanes]{};
  for (std::size_t n = 0; n < count; n += lanes) {
    for (std::size_t l = 0; l < lanes; ++l) {
      const std::size_t m = n + l;
      const double k = chunk.curvature[m];
      const double qx = c.qx[begin + m], qy = c.qy[begin + m], qz = c.qz[begin + m];
      const double tx = chunk.tx[m], ty = chunk.ty[m], tz = chunk.tz[m];
      xx[l] += k * (1 - qx * qx - tx * tx);
      yy[l] += k * (1 - qy * qy - ty * ty);
      zz[l] += k * (1 - qz * qz - tz * tz);
      xy[l] -= k * (qx * qy + tx * ty);
      xz[l] -= k * (qx * qz + tx * tz);
      yz[l] -= k * (qy * qz + ty * tz);
      noise[l] += chunk.noise[m];
    }
  }
  sums.hessian.xx += sum_of(xx);
  sums.hessian.yy += sum_of(yy);
  sums.hessian.zz += sum_of(zz);
  sums.hessian.xy += sum_of(xy);
  sums.hessian.xz += sum_of(xz);
  sums.hessian.yz += sum_of(yz);
  sums.noise += sum_of(noise);
}

void leave_out(Chunk& chunk, std::size_t n) {
  chunk.far[n] = 0;
  chunk.x[n] = chunk.y[n] = chunk.z[n] = chunk.size[n] = chunk.curvature[n] = chunk.noise[n] = 0;
}

}  // namespace

void Columns::fit(std::size_t n) {
  for (auto* column : {&x, &y, &z, &x_low, &y_low, &z_low, &qx, &qy, &qz, &strength, &size}) {
    column->resize(n + lanes);
  }
}

std::size_t Columns::memory_bytes() const noexcept {
  return 11 * x.capacity() * sizeof(double);
}

void Columns::take(std::span<const Placed> sorted) {
  planes = attractors = sorted.size();
  for (std::size_t i = sorted.size(); i-- > 0;) {
    const Placed& placed = sorted[i];
    if (placed.type == PrimitiveType::directed_force) {
      break;
    }
    (placed.type == PrimitiveType::plane ? planes : attractors) = i;
    const FineVec3& offset = placed.offset;
    x[i] = offset.x.hi;
    y[i] = offset.y.hi;
    z[i] = offset.z.hi;
    x_low[i] = offset.x.lo;
    y_low[i] = offset.y.lo;
    z_low[i] = offset.z.lo;
    const Vec3 q = placed.type == PrimitiveType::point ? Vec3{0} : placed.direction;
    qx[i] = q.x;
    qy[i] = q.y;
    qz[i] = q.z;
    strength[i] = placed.strength;
    size[i] = size_of(offset);
  }
  planes = std::min(planes, attractors);
}

std::size_t add_far(const Columns& columns, const FineVec3& z, const ActiveSet& active, double coarseness, double touch,
                    Sums& sums, std::span<Vec3> forces, std::span<std::uint32_t> near) {
  Chunk chunk;
  std::size_t found = 0;
  std::size_t end = 0;
  for (std::size_t begin = columns.planes; begin < forces.size(); begin = end) {
    const bool planes = begin < columns.attractors;
    end = std::min(begin + at_once, planes ? columns.attractors : forces.size());
    const std::size_t count = end - begin;
    (planes ? look_at_planes : look_at_attractors)(columns, begin, count, z, coarseness, touch, chunk);
    for (int j = 0; j < active.count; ++j) {
      if (active.locked[j] >= begin && active.locked[j] < end) {
        leave_out(chunk, active.locked[j] - begin);
      }
    }
    for (std::size_t n = 0; n < count; ++n) {
      forces[begin + n] = {chunk.x[n], chunk.y[n], chunk.z[n]};
      near[found] = static_cast<std::uint32_t>(begin + n);
      found += chunk.far[n] != 0 ? 0 : 1;
    }
    for (std::size_t n = count; n % lanes != 0; ++n) {
      leave_out(chunk, n);
      chunk.tx[n] = chunk.ty[n] = chunk.tz[n] = 0;
    }
    add_forces(chunk, count, sums);
    if (!planes) {
      add_curvatures(columns, begin, chunk, count, sums);
    }
  }
  return found;
}

}  // namespace palpate::solver::internal
