#pragma once

/// The stiffness that holds in the hand: the default simulated device and hand of the design, in closed loop with each
/// solver, pressing and sliding. No safety filter: its limits would hide the ringing.

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace palpate::plugin {

struct HandStudyOptions {
  int hands = 10;     ///< seeded tremors
  double hold_s = 3;  ///< of which the last second is analyzed
  std::vector<double> stiffness_n_per_m{200, 400, 800, 1600, 2400, 3200, 4800, 6400, 9600};
};

/// One scene, motion, solver and stiffness, over all hands.
struct HandStudyRow {
  std::string scene;   ///< "surface + friction" on a flat slab, or "follow + force + surface" in the wind tunnel
  std::string motion;  ///< "press" or "slide"
  std::string solver;  ///< which of the chain were switched on
  double stiffness_n_per_m = 0;
  double median_rms_n = 0;  ///< of the force between 30 and 500 Hz over the last second; median over the hands
  double worst_rms_n = 0;
  double proxy_error_m = 0;  ///< largest distance from the balance's exact proxy, same primitives
  std::size_t capped = 0;    ///< frames that hit a solver's cap
};

/// Whether a hand would call it still: RMS below 2 k q, q the device's position step.
bool is_still(const HandStudyRow& row);

/// progress is told the share done, 0 to 1.
std::vector<HandStudyRow> study_hand(const HandStudyOptions& options, const std::function<void(double)>& progress);

/// RMS of a signal sampled at `rate` Hz between two frequencies, from its discrete Fourier transform (Parseval).
double band_rms(const std::vector<double>& signal, double rate, double low_hz, double high_hz);

}  // namespace palpate::plugin
