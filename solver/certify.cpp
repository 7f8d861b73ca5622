#include "solver/certify.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "solver/exact/settle.h"

namespace palpate::solver {

using internal::FineVec3;
using internal::length_of;

Certificate certify(const Balance& balance, const Vec3& proxy, std::span<const Vec3> forces) noexcept {
  const internal::PlacedPrimitives primitives(balance.primitives, balance.probe);
  const FineVec3 z = internal::exact_difference(proxy, balance.probe);
  const internal::Settled settled = internal::settle_and_bound(primitives, balance.stiffness, z, forces);
  const double moved = length_of((settled.z - z).hi()) * (1 + 0x1p-48);
  const Certificate there{settled.bound.error + moved, settled.bound.backward_error + moved, settled.bound.residual,
                          settled.bound.slack};
  if (moved == 0 || there.error_bound <= promised_accuracy(balance, proxy, forces)) {
    return there;
  }
  const internal::Bound here = internal::bound_at(primitives, balance.stiffness, z, {}, forces);
  return here.error < there.error_bound ? Certificate{here.error, here.backward_error, here.residual, here.slack}
                                        : there;
}

double promised_accuracy(const Balance& balance, const Vec3& proxy, std::span<const Vec3> forces) noexcept {
  double size = std::max(length_of(balance.probe), length_of(proxy));
  double force = 0;
  for (std::size_t i = 0; i < forces.size(); ++i) {
    const double share = length_of(forces[i]);
    force += share;
    if (share > 0 && balance.primitives[i].type != PrimitiveType::directed_force) {
      size = std::max(size, length_of(balance.primitives[i].position));
    }
  }
  constexpr double ulp = std::numeric_limits<double>::epsilon();
  return 1e-14 + 16 * ulp * (size + force / balance.stiffness);
}

}  // namespace palpate::solver
