#include "plugin/openigtlink/marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <set>
#include <string>

#include "plugin/openigtlink/say.h"

namespace palpate::plugin::igtl {
namespace {

constexpr double same_place_mm = 1e-3;  // places on the wire are rounded

bool is_there(const Point& one, const Point& other) {
  return glm::distance(one.position, other.position) <= same_place_mm;
}

/// Names for marks that have none, as free_mark_name() gives them.
class FreeNames {
 public:
  void take(const std::vector<Point>& marks) {
    for (const Point& mark : marks) taken_.insert(mark.name);
  }
  std::string next() {
    std::string name;
    do {
      name = fmt::format("Mark {}", ++last_);
    } while (!taken_.insert(name).second);
    return name;
  }

 private:
  std::set<std::string> taken_;
  int last_ = 0;
};

}  // namespace

std::vector<Point> changed_marks(const std::vector<Point>& known, const std::vector<Point>& sent) {
  std::vector<Point> now = known;
  FreeNames names;
  names.take(known);
  names.take(sent);
  for (const Point& point : sent) {
    const auto same = std::ranges::find_if(
        now, [&](const Point& one) { return point.name.empty() ? is_there(one, point) : one.name == point.name; });
    if (same == now.end()) {
      now.push_back(point);
      if (point.name.empty()) now.back().name = names.next();
    } else if (!is_there(*same, point)) {
      *same = point;
    }
  }
  if (now.size() > std::max(known.size(), most_marks)) {
    throw Refusal(say("igtl-too-many-marks", now.size(), most_marks));
  }
  std::vector<Point> changed;
  for (std::size_t n = 0; n < now.size(); ++n) {
    if (n >= known.size() || !is_there(now[n], known[n])) changed.push_back(now[n]);
  }
  return changed;
}

}  // namespace palpate::plugin::igtl
