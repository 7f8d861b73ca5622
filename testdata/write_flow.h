#pragma once

/// A synthetic 4D-flow study: the flow past a sphere, as a phase-contrast MR scanner would send it.

#include <filesystem>

#include "testdata/flow.h"
#include "testdata/scan.h"

namespace palpate::testdata {

struct FlowStudy {
  FlowPastSphere flow;
  Grid grid;
  int times = 5;             ///< in one cycle
  double cycle_ms = 1000;    ///< of the heart
  double pulsation = 0.5;    ///< the free stream times 1 + pulsation sin(2 pi t / cycle)
  double venc_cm_per_s = 0;  ///< 0: a fifth above the largest speed, so that nothing wraps around
};

/// The free stream at a time point, m/s.
Vec3 free_stream_at(const FlowStudy& study, int time);
/// The fastest speed anywhere at any time.
double fastest_cm_per_s(const FlowStudy& study);

/// Writes four series into `folder`, which must be new or empty: magnitude, and the speeds from right to left, from
/// front to back and from feet to head (12 bit, as Siemens stores them: rescaled to -4096 ... 4094). Each series has a
/// folder with a subfolder for each time. The sphere and all voxels outside the tunnel are padding. Throws as
/// write_series() does, and std::invalid_argument for a study without times or with a venc below its speeds.
void write_flow_study(const FlowStudy& study, const std::filesystem::path& folder);

}  // namespace palpate::testdata
