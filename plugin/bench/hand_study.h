#pragma once

/// The stiffness that stays steady in the hand: simulated arms and hands in closed loop with each solver, pressing and
/// sliding. No safety filter: its limits would hide the ringing.
///
/// The hand means to be as deep as presses it with half of what the surface takes there, F: F (1 / k + 1 / k_h), for
/// its own spring k_h is in series with the scene's k. So contact is kept at every stiffness; each row says how far.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace palpate::plugin {

struct HandStudyOptions {
  int hands = 3;      ///< seeded tremors
  double hold_s = 2;  ///< of which the last second is analyzed
  std::vector<double> stiffness_n_per_m{200, 400, 800, 1600, 2400, 3200, 4800, 6400, 9600};
};

/// One scene, motion, arm, hand, solver and stiffness, over all tremors.
struct HandStudyRow {
  std::string scene;   ///< "surface + friction" on a flat slab, or "follow + force + surface" in the wind tunnel
  std::string motion;  ///< "press" or "slide"
  std::string arm;     ///< of simulated_arms()
  std::string hand;    ///< of simulated_hands()
  std::string solver;  ///< which of the chain were switched on
  double stiffness_n_per_m = 0;
  double median_rms_n = 0;  ///< of the force between 30 and 500 Hz over the last second; median over the tremors
  double worst_rms_n = 0;
  double steady_below_n = 0;  ///< 2 k q, where q is the arm's position step: RMS that is steady
  double kept = 1;            ///< share of the last second's ticks in which the surface held; the least of the tremors
  double proxy_error_m = 0;   ///< largest distance from the balance's exact proxy, same primitives
  std::size_t capped = 0;     ///< ticks that hit a solver's cap
};

/// The names of the solvers in the rows, in their order.
const std::vector<std::string>& hand_study_solvers();

/// Contact was kept in three of four ticks, and the median RMS is below 2 k q.
bool is_steady(const HandStudyRow& row);

/// For every scene, motion, arm, hand and solver the stiffnesses in their order, up to the first that is not steady. On
/// all cores; progress is told the share done, 0 to 1.
std::vector<HandStudyRow> study_hand(const HandStudyOptions& options, const std::function<void(double)>& progress);

/// RMS of a signal sampled at `rate` Hz between two frequencies, from its discrete Fourier transform (Parseval).
double band_rms(const std::vector<double>& signal, double rate, double low_hz, double high_hz);

}  // namespace palpate::plugin
