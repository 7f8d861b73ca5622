#pragma once

#include <optional>

class DcmItem;

namespace palpate::io::internal {

/// The diffusion weighting of a single-frame image, s/mm2: from the standard's attribute, or from the private attribute
/// of Siemens (0019,100C), GE (0043,1039) or Philips (2001,1003). Nothing if all are missing.
std::optional<double> b_value_of(DcmItem& dataset);

}  // namespace palpate::io::internal
