#pragma once

/// The doubtful places of the outline that is corrected, and what has become of each.

#include <functional>
#include <optional>
#include <set>
#include <utility>

#include "io/structures/doubtful_places.h"

namespace palpate::plugin {

class DoubtfulList {
 public:
  /// The distance of a place from the outline as it is felt now, mm; none while it is read or made.
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
  /// The most doubtful first; none while they are looked for.
  const std::optional<io::DoubtfulPlaces>& places() const { return places_; }
  Fate fate(std::size_t place) const;
  /// The user has looked at it: it is right as it is.
  void leave(std::size_t place) { left_.insert(place); }
  /// The one that was gone to last.
  std::optional<std::size_t> at() const { return at_; }
  /// Null: there is no such place.
  const io::DoubtfulPlace* go_to(std::size_t place);

 private:
  Outline outline_;
  std::optional<io::DoubtfulPlaces> places_;
  std::set<std::size_t> left_;
  std::optional<std::size_t> at_;
};

}  // namespace palpate::plugin
