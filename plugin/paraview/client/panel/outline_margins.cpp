#include "plugin/paraview/client/panel/outline_margins.h"

#include <algorithm>

#include "io/structures/compare_outlines.h"

namespace palpate::plugin {
namespace {

/// Its distance is a true one a little less far than it is kept at full detail.
io::ComparedOutline compared(const std::shared_ptr<const io::DistanceField>& outline, const io::StructureBox& box) {
  constexpr double short_of_mm = 1, least_mm = 0.5;
  return {.distance = [outline](const io::Vec3& at) { return outline->sample(at).mm; },
          .box = box,
          .true_to_mm = std::max(outline->reach_mm() - short_of_mm, least_mm)};
}

std::vector<OutlineMargin> margins_from(const std::shared_ptr<const io::DistanceField>& outline,
                                        const io::StructureBox& box, const std::vector<KeepOut>& keep_outs) {
  std::vector<OutlineMargin> margins;
  for (const KeepOut& one : keep_outs) {
    margins.push_back({.name = one.name,
                       .keep_out_mm = one.margin_mm,
                       .mm = io::margin_mm(compared(outline, box), compared(one.outline, one.box))});
  }
  return margins;
}

}  // namespace

void OutlineMargins::measure(const std::shared_ptr<const io::DistanceField>& outline, const io::StructureBox& box,
                             const std::vector<KeepOut>& keep_outs) {
  if (outline_ == outline && keep_outs_ == keep_outs) return;
  outline_ = outline;
  keep_outs_ = keep_outs;
  margins_.clear();
  job_.cancel();
  if (keep_outs.empty()) return;
  job_.ask([outline, keep_outs, box] { return margins_from(outline, box, keep_outs); },
           [this](const auto& measured, const QString&) {
             if (measured) margins_ = *measured;
             measured_();
           });
}

void OutlineMargins::forget() {
  job_.cancel();
  outline_ = nullptr;
  keep_outs_.clear();
  margins_.clear();
}

std::vector<OutlineMargin> OutlineMargins::of(const std::shared_ptr<const io::DistanceField>& outline) const {
  return outline == outline_ ? margins_ : std::vector<OutlineMargin>();
}

}  // namespace palpate::plugin
