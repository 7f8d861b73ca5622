#include "plugin/paraview/client/model/open_views.h"

#include <algorithm>

namespace palpate::plugin {

OpenViews::Following OpenViews::follow(Layer layer, Opened opened, SliceShown slice_shown) {
  if (!views_.empty()) opened(views_);
  const auto above = std::ranges::find_if(followers_, [layer](const Follower& one) { return one.layer > layer; });
  const auto place = followers_.insert(above, {layer, std::move(opened), std::move(slice_shown)});
  return Following([this, place] { followers_.erase(place); });
}

void OpenViews::set(std::vector<ClinicalView> views) {
  views_ = std::move(views);
  if (views_.empty()) {
    for (auto one = followers_.rbegin(); one != followers_.rend(); ++one) one->opened(views_);
  } else {
    for (const Follower& one : followers_) one.opened(views_);
  }
}

void OpenViews::show_slice(SliceView& slice) const {
  for (const Follower& one : followers_) {
    if (one.slice_shown) one.slice_shown(slice);
  }
}

}  // namespace palpate::plugin
