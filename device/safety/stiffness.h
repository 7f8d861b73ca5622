#pragma once

/// How stiff a wall may be that a sampled, delayed, quantised device renders without ringing.

namespace palpate::device {

struct RenderingDynamics {
  double device_damping = 0;    ///< N s/m: viscous friction of the arm
  double hand_damping = 0;      ///< N s/m: what a hand adds while it holds the stylus
  double coulomb_friction = 0;  ///< N
  double position_step = 0;     ///< m
  double period = 1e-3;         ///< s: the servo tick
  double delay = 0;             ///< s: from reading the pose to the force at the arm, beyond the hold
};

/// N/m, all of them.
struct StiffnessBounds {
  double passive = 0;    ///< never gives energy, with no hand: b / (T/2 + t_d); J. E. Colgate and G. Schenkel, 1997
  double held = 0;       ///< the same with the hand's damping
  double near_rest = 0;  ///< friction eats the energy of the position steps: 2 c / D; N. Diolaiti et al., 2006
  double advised = 0;    ///< the cap: see stiffness_bounds()
};

/// Real arms have almost no damping, which makes `passive` useless as a cap, and `near_rest` holds only for small
/// motion while a hand's damping varies: so the cap is the larger of `passive` and the smaller of `held` and
/// `near_rest`, the latter two reduced by `margin`, and never above `configured`.
StiffnessBounds stiffness_bounds(const RenderingDynamics& dynamics, double configured = 3000, double margin = 0.6);

}  // namespace palpate::device
