#pragma once

/// The doubtful places of the outline that is corrected, and the state of each.

#include <functional>
#include <optional>
#include <set>
#include <utility>

#include "io/structures/doubtful_places.h"

namespace palpate::plugin {

class DoubtfulList {
 public:
  /// The distance of a place from the felt outline, mm; none while the outline is being read or computed.
  using Outline = std::function<std::optional<double>(const io::Vec3& place)>;
  enum class Fate { doubtful, corrected, left };

  void set_outline(Outline outline) { outline_ = std::move(outline); }
  void take(io::DoubtfulPlaces found) {
    clear();
    places_ = std::move(found);
  }
  void clear() {
    places_.reset();
    left_.clear();
    at_.reset();
  }
  /// The most doubtful first; none during the search.
  const std::optional<io::DoubtfulPlaces>& places() const { return places_; }
  Fate fate(std::size_t place) const;
  /// Records that the user accepts the outline at this place.
  void leave(std::size_t place) { left_.insert(place); }
  /// The place visited last.
  std::optional<std::size_t> at() const { return at_; }
  /// Null if there is no such place.
  const io::DoubtfulPlace* go_to(std::size_t place);

 private:
  Outline outline_;
  std::optional<io::DoubtfulPlaces> places_;
  std::set<std::size_t> left_;
  std::optional<std::size_t> at_;
};

}  // namespace palpate::plugin
