#pragma once

/// ParaView's time, which says which frame of a scan is shown.

namespace palpate::plugin {

/// Every view goes to it. No step that can be undone.
void set_animation_time(double time);

}  // namespace palpate::plugin
