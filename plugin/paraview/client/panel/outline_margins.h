#pragma once

/// How far a structure that is corrected is from what the stylus is kept out of.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io/structures/distance_field.h"
#include "io/structures/structure.h"
#include "plugin/paraview/client/jobs/job.h"

namespace palpate::plugin {

/// A structure as it is felt, and a box that holds it.
struct KeepOut {
  std::string name;
  double margin_mm = 0;  ///< at which its force begins
  std::shared_ptr<const io::DistanceField> outline;
  io::StructureBox box;
  bool operator==(const KeepOut& other) const {
    return name == other.name && margin_mm == other.margin_mm && outline == other.outline;
  }
};

struct OutlineMargin {
  std::string name;
  double keep_out_mm = 0;  ///< at which its force begins
  double mm = 0;           ///< the smallest distance between the surfaces; below 0: how deep one reaches into the other
};

/// Measures in the background: it takes up to seconds.
class OutlineMargins {
 public:
  /// `measured`: of() has changed.
  explicit OutlineMargins(std::function<void()> measured) : measured_(std::move(measured)) {}

  /// Again where the outline or one of the others has changed. `box` holds the outline.
  void measure(const std::shared_ptr<const io::DistanceField>& outline, const io::StructureBox& box,
               const std::vector<KeepOut>& keep_outs);
  /// Another scan.
  void forget();
  /// Those of this outline; empty while they are measured, and of any other.
  std::vector<OutlineMargin> of(const std::shared_ptr<const io::DistanceField>& outline) const;

 private:
  std::function<void()> measured_;
  std::shared_ptr<const io::DistanceField> outline_;
  std::vector<KeepOut> keep_outs_;
  std::vector<OutlineMargin> margins_;
  Job job_{Job::Newer::follows};
};

}  // namespace palpate::plugin
