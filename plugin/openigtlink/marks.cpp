#include "plugin/openigtlink/marks.h"

#include <fmt/format.h>

#include <algorithm>
#include <glm/geometric.hpp>
#include <set>
#include <string>
#include <utility>

#include "plugin/openigtlink/say.h"

namespace palpate::plugin::igtl {
namespace {

constexpr double same_place_mm = 1e-3;  // places on the wire are rounded

bool is_there(const Point& one, const Point& other) {
  return glm::distance(one.position, other.position) <= same_place_mm;
}

/// The marks' names as they come back from a client that gets the marks and sends them.
std::vector<std::string> names_of_echo(const std::vector<Point>& marks) {
  std::vector<Point> points;
  for (const Point& mark : marks) points.push_back({.name = mark.name});
  std::vector<std::string> names;
  for (Point& point : points_of(content_of(points))) names.push_back(std::move(point.name));
  return names;
}

Point with_name(Point point, const std::string& name) {
  point.name = name;
  return point;
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

std::vector<ChangedMark> changed_marks(const std::vector<Point>& known, const std::vector<Point>& sent) {
  std::vector<Point> now = known;
  std::vector<std::string> names = names_of_echo(known);
  const std::vector<std::string> asked = names_of_echo(sent);
  const auto find = [&](std::size_t n, const auto& fits) {
    std::size_t at = 0;
    while (at < now.size() && !((asked[n].empty() || names[at] == asked[n]) && fits(at))) ++at;
    return at;
  };
  const auto find_there = [&](std::size_t n) {
    return find(n, [&](std::size_t at) { return is_there(now[at], sent[n]); });
  };
  std::vector<bool> stays(known.size());
  for (std::size_t n = 0; n < sent.size(); ++n) {
    const std::size_t at = find_there(n);
    if (at < known.size() && !asked[n].empty()) stays[at] = true;
  }
  for (std::size_t n = 0; n < sent.size(); ++n) {
    if (asked[n].empty() || find_there(n) < known.size()) continue;
    const std::size_t at = find(n, [&](std::size_t one) { return !stays[one]; });
    if (at == known.size()) continue;
    now[at] = with_name(sent[n], known[at].name);
    stays[at] = true;
  }
  FreeNames fresh;
  fresh.take(known);
  fresh.take(sent);
  for (std::size_t n = 0; n < sent.size(); ++n) {
    if (find_there(n) < now.size()) continue;
    now.push_back(asked[n].empty() ? with_name(sent[n], fresh.next()) : sent[n]);
    names.push_back(asked[n].empty() ? now.back().name : asked[n]);
  }
  if (now.size() > std::max(known.size(), most_marks)) {
    throw Refusal(say("igtl-too-many-marks", now.size(), most_marks));
  }
  std::vector<ChangedMark> changed;
  for (std::size_t at = 0; at < now.size(); ++at) {
    if (at >= known.size() || !is_there(now[at], known[at])) changed.push_back({at, now[at]});
  }
  return changed;
}

}  // namespace palpate::plugin::igtl
