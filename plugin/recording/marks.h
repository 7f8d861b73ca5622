#pragma once

/// Marks made while feeling, with the stylus' second button or the panel's *Mark*. Patient space (LPS, mm).

#include <cstdint>
#include <glm/vec3.hpp>
#include <optional>
#include <span>
#include <string>
#include <variant>
#include <vector>

#include "modes/scene/scene.h"
#include "plugin/session/tick_record.h"

namespace palpate::plugin {

class RecordedSession;

/// The second button, in TickRecord::buttons.
constexpr std::uint32_t mark_button = 2;

/// A point on what was felt: the proxy where the button was pressed.
struct FeltMark {
  std::string name;
  std::uint64_t tick = 0;  ///< index of the tick
  double time_s = 0;       ///< since the session or its recording began
  glm::dvec3 position_mm{0};
  /// The mode (its name, or else its type) of the strongest boundary that held the stylus with more than 0.05 N; empty:
  /// none did. Forces that act everywhere, such as friction, are no boundaries.
  std::string boundary;
  double value = 0;    ///< of the scan; NaN outside
  double force_n = 0;  ///< on the stylus
};

/// The path of the proxy while the button was held down.
struct MarkedPath {
  std::string name;
  double begin_s = 0, end_s = 0;
  std::vector<glm::dvec3> points_mm;
  double length_mm = 0;
  double touched_mm = 0;  ///< length in contact with a boundary; NaN: unknown
};

/// Whether a boundary held the stylus along the whole path, nowhere, or on parts of it.
enum class PathContact { all_along, nowhere, partly, unknown };
PathContact contact_of(const MarkedPath& path);

/// The distance between two marks.
struct MarkedDistance {
  std::size_t from = 0, to = 0;  ///< indices of marks
  double mm = 0;
};

/// The angle at a mark, between two others.
struct MarkedAngle {
  std::size_t from = 0, at = 0, to = 0;  ///< indices of marks
  double degrees = 0;
};

struct Marks {
  std::vector<FeltMark> points;
  std::vector<MarkedPath> paths;
  std::vector<MarkedDistance> distances;
  std::vector<MarkedAngle> angles;
};

/// The result of a press, without a name.
using MarkMade = std::variant<FeltMark, MarkedPath>;

/// Follows the mark button from tick to tick. A press that is shorter than 0.25 s, or during which the proxy stays
/// within 2 mm, makes a mark at the place where it began; any other makes a path.
class MarkPresses {
 public:
  struct Moment {
    const TickRecord& tick;
    double time_s = 0;
    glm::dvec3 proxy_mm{0};
    std::span<const PrimitiveRecord> shares;
    const modes::Scene& scene;  ///< the felt scene
  };
  /// The result of a press that ended in this tick.
  std::optional<MarkMade> take(const Moment& moment);
  /// The same after the last tick.
  std::optional<MarkMade> finish();
  /// Cancels the current press.
  void drop() { down_ = false; }
  bool is_down() const { return down_; }

 private:
  bool down_ = false, moved_ = false, touches_ = false;
  FeltMark mark_;
  MarkedPath path_;
  glm::dvec3 last_mm_{0};
};

/// The marks of a recording, with the distance from each mark to the next, and the angle at each mark with two
/// neighbors.
Marks marks_of(const RecordedSession& session);

/// The length of a distance, and the angle at a mark; no angle if two of the places are equal.
double distance_mm(const Marks& marks, std::size_t from, std::size_t to);
std::optional<double> angle_degrees(const Marks& marks, std::size_t from, std::size_t at, std::size_t to);

/// "Mark 3", "Path 1": with the lowest number that is not used yet.
std::string free_mark_name(const Marks& marks);
std::string free_path_name(const Marks& marks);
/// Removes a mark, and the distances and angles that it is part of.
void remove_mark(Marks& marks, std::size_t mark);
/// Measures distances and angles again, after marks were moved. Removes an angle that no longer exists.
void measure_again(Marks& marks);

}  // namespace palpate::plugin
