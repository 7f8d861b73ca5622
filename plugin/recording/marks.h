#pragma once

/// Marks that the hand made while feeling: where the stylus' second button was pressed. Patient space (LPS, mm).

#include <cstdint>
#include <glm/vec3.hpp>
#include <string>
#include <vector>

#include "plugin/recording/recorded_session.h"

namespace palpate::plugin {

/// The second button, in TickRecord::buttons.
constexpr std::uint32_t mark_button = 2;

/// A point on what was felt: the proxy where the button was pressed.
struct FeltMark {
  std::string name;
  std::uint64_t tick = 0;  ///< index of the tick
  double time_s = 0;       ///< since the recording began
  glm::dvec3 position_mm{0};
  std::string boundary;  ///< the mode that pushed most, by its name or type; empty: nothing was felt
  double value = 0;      ///< of the scan; NaN outside
  double force_n = 0;    ///< N, of what the stylus was fed
};

/// The proxy's way while the button was kept down.
struct MarkedPath {
  std::string name;
  double begin_s = 0, end_s = 0;
  std::vector<glm::dvec3> points_mm;
  double length_mm = 0;
};

/// From a mark to the next.
struct MarkedDistance {
  std::size_t from = 0, to = 0;  ///< indices of marks
  double mm = 0;
};

/// At a mark, between the one before it and the next.
struct MarkedAngle {
  std::size_t at = 0;
  double degrees = 0;
};

struct Marks {
  std::vector<FeltMark> points;
  std::vector<MarkedPath> paths;
  std::vector<MarkedDistance> distances;
  std::vector<MarkedAngle> angles;
};

/// A press during which the proxy stays within 2 mm is a mark where it began; any other is a path.
Marks marks_of(const RecordedSession& session);

}  // namespace palpate::plugin
