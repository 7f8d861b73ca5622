#pragma once

/// The highest stiffness that is steady in the hand: simulated arms and hands in closed loop with each solver, pressing
/// and sliding. Without a safety filter, whose limits would hide the ringing.
///
/// The hand's target is deep enough to press with half of the surface's largest force there, F: F (1 / k + 1 / k_h),
/// because its own spring k_h is in series with the scene's k. So contact should be kept at every stiffness; each row
/// states how much was.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace palpate::plugin {

struct HandStudyOptions {
  int hands = 3;      ///< tremors with different seeds
  double hold_s = 2;  ///< of which the last second is analyzed
  std::vector<double> stiffness_n_per_m{200, 400, 800, 1600, 2400, 3200, 4800, 6400, 9600};
};

/// One scene, motion, arm, hand, solver and stiffness, over all tremors.
struct HandStudyRow {
  std::string scene;   ///< "surface + friction" on a flat slab, or "follow + force + surface" in the wind tunnel
  std::string motion;  ///< "press" or "slide"
  std::string arm;     ///< of simulated_arms()
  std::string hand;    ///< of simulated_hands()
  std::string solver;  ///< the solvers of the chain that were switched on
  double stiffness_n_per_m = 0;
  double median_rms_n = 0;  ///< of the force between 30 and 500 Hz over the last second; median over the tremors
  double worst_rms_n = 0;
  double steady_below_n = 0;  ///< 2 k q, where q is the arm's position step: RMS that is steady
  double kept = 1;            ///< fraction of the last second's ticks in which the surface held; least over the tremors
  double proxy_error_m = 0;   ///< largest distance from the balance's exact proxy, same primitives
  std::size_t capped = 0;     ///< ticks that hit a solver's cap
};

/// The names of the solvers in the rows, in order.
const std::vector<std::string>& hand_study_solvers();

/// Contact was kept in three of four ticks, and the median RMS is below 2 k q.
bool is_steady(const HandStudyRow& row);

/// For every scene, motion, arm, hand and solver the stiffnesses in order, up to the first unsteady one. On all cores;
/// progress gets the fraction done, 0 to 1.
std::vector<HandStudyRow> study_hand(const HandStudyOptions& options, const std::function<void(double)>& progress);

/// RMS of a signal sampled at `rate` Hz between two frequencies, from its discrete Fourier transform (Parseval).
double band_rms(const std::vector<double>& signal, double rate, double low_hz, double high_hz);

}  // namespace palpate::plugin
