#pragma once

/// Pictures of a session: its path, the forces, and the times of its ticks.

#include <array>
#include <filesystem>
#include <vector>

#include "io/fields/field_source.h"
#include "modes/scene/plan.h"
#include "modes/scene/scene.h"
#include "plugin/recording/recording.h"
#include "plugin/report/chart.h"
#include "plugin/report/slice_picture.h"
#include "plugin/report/summary.h"

namespace palpate::plugin {

/// The charts of force-depth.png: force and value against the distance of the probe from the first contact along the
/// direction of pressing (mm).
std::array<Chart, 2> force_depth_charts(const Recording& recording, const Summary& summary, const modes::Scene& scene,
                                        const modes::Plan& plan, const std::string& unit);
/// The chart of force-time.png: the force sent, and each mode's share of it.
Chart force_time_chart(const Recording& recording, const modes::Scene& scene);
/// The chart of tick-time.png: twenty bins a decade from 0.1 us to 10 ms.
Chart tick_time_chart(const Recording& recording, const Summary& summary);
/// The plane of slice.png: the anatomical plane nearest to the path, oriented as by radiologists (axial from the feet,
/// coronal from the front, sagittal from the left).
SliceView slice_view(const Recording& recording, const modes::Plan& plan, const std::string& unit,
                     const io::FieldSource& source);
/// The arrows of slice.png: one for every millimeter of the probe's travel with a force.
std::vector<ForceArrow> force_arrows(const Recording& recording, const modes::Plan& plan);

/// Writes slice.png, force-depth.png, force-time.png and tick-time.png into the folder; returns their names. `unit` is
/// the scan's. Throws std::runtime_error naming the file.
std::vector<std::string> write_session_pictures(const Recording& recording, const Summary& summary,
                                                const modes::Scene& scene, const modes::Plan& plan,
                                                const io::FieldSource& source, const std::string& unit,
                                                const std::filesystem::path& folder);

}  // namespace palpate::plugin
