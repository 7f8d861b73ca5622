#pragma once

/// How a scan is to look: gray windows for its slices, colors and opacity for its volume, from what it is and how its
/// values are spread.

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

namespace palpate::plugin {

/// Values below level - width / 2 are black, above level + width / 2 white.
struct Window {
  double level = 40;
  double width = 400;
};

struct NamedWindow {
  const char* name = "";  ///< English, for tr()
  Window window;
};

/// What is known of a scan's values.
struct Values {
  std::string modality;        ///< DICOM's: "CT", "MR", ...
  bool hounsfield = false;     ///< whether their unit is HU
  double low = 0;              ///< least
  double high = 1;             ///< greatest
  std::optional<Window> own;   ///< what the series asks for
  std::vector<double> shares;  ///< below the n-th are n percent of the voxels; ascending; may be empty
};

/// What is offered for the slices, what is shown first first: the series' own window; then for HU brain, soft tissue,
/// lung and bone; for all else the middle 98 percent of the values, and all of them. Never empty.
std::vector<NamedWindow> windows_for(const Values& values);

/// As vtkColorTransferFunction (value, red, green, blue) and vtkPiecewiseFunction (value, opacity, 0.5, 0) take them.
struct VolumeLook {
  const char* name = "";  ///< English, for tr()
  std::vector<double> colors;
  std::vector<double> opacity;
  bool shaded = true;  ///< as by a lamp at the eye
};

/// What is offered for the volume. HU: CT skin, bone, lung, vessels. Others: MR, which is what is brighter than the
/// background (Otsu's threshold, from the values' spread), and MR vessels, a few percent that are brightest.
std::vector<VolumeLook> volume_looks_for(const Values& values);

/// Which of them suits the scan. HU: skin; bone where there is no air round the patient; lung where a tenth of the body
/// or more is as light as it is. Others: vessels where what is brighter than the background is a few percent.
std::size_t suited_look(const Values& values);

/// The value that splits the spread best into two classes (Otsu, "A threshold selection method from gray-level
/// histograms", 1979). Needs shares.
double otsu_threshold(const std::vector<double>& shares);

}  // namespace palpate::plugin
