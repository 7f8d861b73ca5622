#include "plugin/paraview/client/model/doubtful_list.h"

#include <algorithm>
#include <cmath>

namespace palpate::plugin {

/// A place is corrected if the felt outline has moved away from it by a good part of its error. An edit that was held
/// back there, or made elsewhere, corrects nothing.
DoubtfulList::Fate DoubtfulList::fate(std::size_t place) const {
  constexpr double least_mm = 0.3, least_part = 0.5;
  const io::DoubtfulPlace& one = places_->places[place];
  const double off_mm = std::abs(outline_ ? outline_(one.position_mm).value_or(0) : 0);
  if (off_mm > std::max(least_mm, least_part * std::abs(one.mean_mm))) return Fate::corrected;
  return left_.contains(place) ? Fate::left : Fate::doubtful;
}

const io::DoubtfulPlace* DoubtfulList::go_to(std::size_t place) {
  if (!places_ || place >= places_->places.size()) return nullptr;
  at_ = place;
  return &places_->places[place];
}

}  // namespace palpate::plugin
