#include "plugin/bench/subdivision_study.h"

#include <memory>

#include "io/fields/volume_fields.h"
#include "plugin/report/summary.h"
#include "testdata/analytic.h"
#include "testdata/scan.h"

namespace palpate::plugin {

SubdivisionRow study_subdivision(Wall wall, double speed_mm_per_s, int most_sub_steps) {
  modes::Scene scene = wall_scene();
  scene.subdivision.most = most_sub_steps;
  scene.subdivision.most_halts = 0;  // the sub-steps alone
  const testdata::AnalyticSource exact(phantom_of(wall), 1.0);
  const Slide slide = slide_on(wall, exact, scene, speed_mm_per_s);
  auto volume = std::make_shared<const io::Volume>(testdata::scan(phantom_of(wall), testdata::make_geometry({})));
  const double scale_mm = io::default_gradient_scale_mm(volume->geometry);
  const io::VolumeFields scanned(volume, io::FieldSet::value | io::FieldSet::gradient, scale_mm);
  scanned.prepare({0, 0, 0}, 30);
  return {.wall = wall,
          .speed_mm_per_s = speed_mm_per_s,
          .most_sub_steps = most_sub_steps,
          .sub_steps = slide.sub_steps,
          .worst_deg = slide.worst_deg,
          .worst_force_n = slide.worst_force_n,
          .drift_mm = slide.drift_mm,
          .tick_us = percentiles_of(slide_on(wall, scanned, scene, speed_mm_per_s).ticks_us).median};
}

}  // namespace palpate::plugin
