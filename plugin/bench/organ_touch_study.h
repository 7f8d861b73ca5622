#pragma once

/// Whether touch helps a simulated hand to correct outlines of real organs (touch_study.h has the phantom). An organ's
/// own outline counts as the truth. Copies of it get errors at places where it agrees with an edge of the scan.

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "io/structures/structure.h"
#include "io/volume.h"

namespace palpate::plugin {

struct OrganTouchOptions {
  std::vector<std::string> organs;  ///< names; empty: the largest three
  int hands = 3;
};

/// Prints a table and returns it as CSV. Throws InputRefused if no such organ lies on the scan.
std::string study_touch_on_organs(const std::shared_ptr<const io::Volume>& scan,
                                  const std::vector<io::Structure>& structures, const OrganTouchOptions& options);

}  // namespace palpate::plugin
