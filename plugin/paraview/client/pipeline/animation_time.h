#pragma once

/// ParaView's time, which selects the frame of a scan.

namespace palpate::plugin {

/// Moves every view to this time. Not a step that can be undone.
void set_animation_time(double time);

}  // namespace palpate::plugin
