#pragma once

/// Which forces a hand can tell apart.

namespace palpate::plugin {

/// By this part two forces have to differ. Hands tell forces of 2 to 10 N apart that differ by 7 % (Pang, Tan and
/// Durlach, "Manual discrimination of force using active finger motion", Perception & Psychophysics 49, 1991; Jones,
/// "Matching forces: constant errors and differential thresholds", Perception 18, 1989), and weaker ones less well.
inline constexpr double weber_fraction = 0.1;

/// N, not negative. Whether a hand may take the one for the other.
bool feels_alike(double a_n, double b_n);

}  // namespace palpate::plugin
