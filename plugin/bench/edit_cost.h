#pragma once

#include <string>

namespace palpate::plugin {

/// Prints a table of the time of each type of edit on a ball of voxels of 1 mm, and returns it as CSV. The time is the
/// best of some rounds, with the processor time of that round: only the former includes other programs' load.
std::string tabulate_edit_costs(int rounds);

}  // namespace palpate::plugin
