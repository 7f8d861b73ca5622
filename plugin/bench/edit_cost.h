#pragma once

#include <string>

namespace palpate::plugin {

/// What an edit of each kind costs on a ball of voxels of 1 mm, printed as a table; the rows as CSV. The time is the
/// best of some rounds, and the processor's time in it: what else the machine does is in the first alone.
std::string tabulate_edit_costs(int rounds);

}  // namespace palpate::plugin
