#pragma once

/// The rows of the list of marks: marks, paths, distances and angles, in this order.

#include <cstddef>
#include <optional>
#include <vector>

#include "plugin/recording/marks.h"

namespace palpate::plugin {

struct MarkRow {
  enum class Kind { mark, path, distance, angle };
  Kind kind = Kind::mark;
  std::size_t index = 0;  ///< among those of its kind

  bool operator==(const MarkRow&) const = default;
};

std::vector<MarkRow> rows_of(const Marks& marks);

/// For each row of `now`: the row of `before` with the same item; none if the item is new. Rows never change their
/// order.
std::vector<std::optional<std::size_t>> former_rows(const Marks& before, const Marks& now);

}  // namespace palpate::plugin
