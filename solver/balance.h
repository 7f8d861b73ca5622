#pragma once

/// The force balance of one tick, equations (1) and (7): find the proxy where the coupling's pull equals the sum of
/// the primitives' forces. It is the minimum of a strongly convex energy, so it exists and is unique for every
/// combination of primitives (infinite strength included, as long as the hard constraints have a common point).

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>

#include "solver/primitive.h"
#include "solver/text/message.h"

namespace palpate::solver {

/// The equation to solve. Holds the primitives by reference: they have to outlive it.
struct Balance {
  double stiffness = 0;    ///< k, N/m, > 0: of the coupling between probe and proxy
  Vec3 probe{0};           ///< m: where the hand is
  Vec3 previous_proxy{0};  ///< m: the proxy of the previous tick, where descent starts
  std::span<const Primitive> primitives;
};

/// f = -k (probe - proxy), equation (1): the force for the device, N.
Vec3 coupling_force(const Balance& balance, const Vec3& proxy);

/// epsilon = -f(proxy) + sum F_i(proxy), equation (7): N. A constraint that holds the proxy is not counted in it.
Vec3 residual(const Balance& balance, const Vec3& proxy);

/// The faults that the numbers of a balance can have.
enum class Flaw : std::uint8_t {
  not_finite,      ///< NaN; or infinite, although it is not a constraint's strength
  negative,        ///< a strength below zero
  not_positive,    ///< a stiffness that is zero or less
  zero_direction,  ///< a direction of zero (or not normalizable) length
  incompatible,    ///< hard constraints without a common point
  out_of_range     ///< larger than largest_quantity, or a stiffness below smallest_stiffness
};

/// The largest quantity (m, N, N/m) that is accepted. The products of larger ones would leave the range of a double.
inline constexpr double largest_quantity = 1e50;
/// N/m.
inline constexpr double smallest_stiffness = 1e-50;

enum class Field : std::uint8_t { stiffness, probe, previous_proxy, strength, position, direction };

/// Why a balance is refused.
struct Rejection {
  static constexpr std::size_t whole_balance = static_cast<std::size_t>(-1);
  std::size_t primitive = whole_balance;  ///< index into Balance::primitives, or whole_balance
  Field field = Field::stiffness;
  Flaw flaw = Flaw::not_finite;
  double value =
      0;  ///< the faulty number; for incompatible constraints, the distance of the primitive from the proxy, m
};

/// The first flaw, in the order stiffness, probe, previous proxy, primitives; nothing if the numbers are usable.
/// (Incompatible hard constraints are found by the solvers.) O(n), no allocation.
std::optional<Rejection> validate(const Balance& balance);

/// In words: "primitive 2: strength is negative (-1)". Allocates: not for the tick.
Text describe(const Rejection& rejection);

}  // namespace palpate::solver
