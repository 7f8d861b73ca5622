#pragma once

/// The stiffest wall that a sampled, delayed and quantized device renders without ringing.

namespace palpate::device {

struct RenderingDynamics {
  double device_damping = 0;    ///< N s/m: viscous friction of the arm
  double hand_damping = 0;      ///< N s/m: damping by the hand that holds the stylus
  double coulomb_friction = 0;  ///< N
  double position_step = 0;     ///< m
  double period = 1e-3;         ///< s: the servo tick
  double delay = 0;             ///< s: from reading the pose to the force at the arm, without the zero-order hold
};

/// N/m, all of them.
struct StiffnessBounds {
  double passive = 0;    ///< passive without a hand: b / (T/2 + t_d); J. E. Colgate and G. Schenkel, 1997
  double held = 0;       ///< the same with the hand's damping
  double near_rest = 0;  ///< friction absorbs the energy of the position steps: 2 c / D; N. Diolaiti et al., 2006
  double advised = 0;    ///< the cap: see stiffness_bounds()
};

/// No bound is enough by itself: real arms have almost no damping, so `passive` is far too low; `near_rest` holds for
/// small motion only; and a hand's damping varies. So the cap is the larger of two numbers: `passive`, and the smaller
/// of `held` and `near_rest`, both reduced by `margin`. It is never above `configured`.
StiffnessBounds stiffness_bounds(const RenderingDynamics& dynamics, double configured = 3000, double margin = 0.6);

}  // namespace palpate::device
