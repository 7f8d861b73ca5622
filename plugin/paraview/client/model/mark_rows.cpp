#include "plugin/paraview/client/model/mark_rows.h"

namespace palpate::plugin {
namespace {

bool is_same(const FeltMark& one, const FeltMark& other) {
  return one.name == other.name && one.tick == other.tick && one.position_mm == other.position_mm;
}
bool is_same(const MarkedPath& one, const MarkedPath& other) {
  return one.name == other.name && one.begin_s == other.begin_s && one.points_mm == other.points_mm;
}
// By their values: the indices of their marks change where an earlier mark is deleted.
bool is_same(const MarkedDistance& one, const MarkedDistance& other) {
  return one.mm == other.mm;
}
bool is_same(const MarkedAngle& one, const MarkedAngle& other) {
  return one.degrees == other.degrees;
}

/// Appends the former rows of one kind; `first`: the row of the first item in `before`. An edit changes one item and
/// keeps their number, or it adds or removes some and changes none.
template <typename Item>
void append(std::vector<std::optional<std::size_t>>& rows, std::size_t first, const std::vector<Item>& before,
            const std::vector<Item>& now) {
  std::size_t n = 0;
  for (const Item& item : now) {
    if (before.size() > now.size()) {
      while (n < before.size() && !is_same(before[n], item)) ++n;
    }
    const bool found = n < before.size() && (before.size() == now.size() || is_same(before[n], item));
    rows.push_back(found ? std::optional(first + n++) : std::nullopt);
  }
}

}  // namespace

std::vector<MarkRow> rows_of(const Marks& marks) {
  using Kind = MarkRow::Kind;
  std::vector<MarkRow> rows;
  const auto append = [&rows](Kind kind, std::size_t count) {
    for (std::size_t n = 0; n < count; ++n) rows.push_back({kind, n});
  };
  append(Kind::mark, marks.points.size());
  append(Kind::path, marks.paths.size());
  append(Kind::distance, marks.distances.size());
  append(Kind::angle, marks.angles.size());
  return rows;
}

std::vector<std::optional<std::size_t>> former_rows(const Marks& before, const Marks& now) {
  std::vector<std::optional<std::size_t>> rows;
  std::size_t first = 0;
  append(rows, first, before.points, now.points);
  append(rows, first += before.points.size(), before.paths, now.paths);
  append(rows, first += before.paths.size(), before.distances, now.distances);
  append(rows, first += before.distances.size(), before.angles, now.angles);
  return rows;
}

}  // namespace palpate::plugin
