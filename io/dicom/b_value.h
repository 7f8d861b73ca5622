#pragma once

#include <optional>

class DcmItem;

namespace palpate::io::internal {

/// The diffusion weighting of a single-frame image, s/mm2: by the standard's attribute, or by the private one that
/// Siemens (0019,100C), GE (0043,1039) or Philips (2001,1003) write instead. Nothing if it has none of them.
std::optional<double> b_value_of(DcmItem& dataset);

}  // namespace palpate::io::internal
