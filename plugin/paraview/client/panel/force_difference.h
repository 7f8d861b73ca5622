#pragma once

/// Which forces a hand can tell apart.

namespace palpate::plugin {

/// The relative difference from which two forces can be told apart. The threshold of a hand is 7 % for forces of 2 to
/// 10 N (Pang, Tan and Durlach, "Manual discrimination of force using active finger motion", Perception & Psychophysics
/// 49, 1991; Jones, "Matching forces: constant errors and differential thresholds", Perception 18, 1989), and larger
/// for weaker ones.
inline constexpr double weber_fraction = 0.1;

/// Whether a hand may confuse two forces; N, not negative.
bool feels_alike(double a_n, double b_n);

}  // namespace palpate::plugin
