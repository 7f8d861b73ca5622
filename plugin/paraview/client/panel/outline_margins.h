#pragma once

/// The distances between a corrected structure and the structures that the stylus is kept out of.

#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "io/structures/distance_field.h"
#include "io/structures/structure.h"
#include "plugin/paraview/client/jobs/job.h"

namespace palpate::plugin {

/// The field of a felt structure, and a box that contains it.
struct KeepOut {
  std::string name;
  double margin_mm = 0;  ///< from its surface, where its force begins
  std::shared_ptr<const io::DistanceField> outline;
  io::StructureBox box;
  bool operator==(const KeepOut& other) const {
    return name == other.name && margin_mm == other.margin_mm && outline == other.outline;
  }
};

struct OutlineMargin {
  std::string name;
  double keep_out_mm = 0;  ///< from its surface, where its force begins
  double mm = 0;           ///< the smallest distance between the surfaces; below 0: the depth of their overlap
};

/// Measures in the background, which takes up to seconds.
class OutlineMargins {
 public:
  /// `measured`: of() has changed.
  explicit OutlineMargins(std::function<void()> measured) : measured_(std::move(measured)) {}

  /// Measures again if the outline or one of the others has changed. `box` contains the outline.
  void measure(const std::shared_ptr<const io::DistanceField>& outline, const io::StructureBox& box,
               const std::vector<KeepOut>& keep_outs);
  /// Another scan.
  void forget();
  /// The margins of this outline; empty while they are being measured, and for any other outline.
  std::vector<OutlineMargin> of(const std::shared_ptr<const io::DistanceField>& outline) const;

 private:
  std::function<void()> measured_;
  std::shared_ptr<const io::DistanceField> outline_;
  std::vector<KeepOut> keep_outs_;
  std::vector<OutlineMargin> margins_;
  Job job_{Job::Newer::follows};
};

}  // namespace palpate::plugin
