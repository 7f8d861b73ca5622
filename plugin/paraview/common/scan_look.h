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
  std::string modality;                   ///< DICOM's: "CT", "MR", ...
  bool hounsfield = false;                ///< whether their unit is HU
  bool speeds = false;                    ///< whether they are in m/s
  double low = 0;                         ///< least
  double high = 1;                        ///< greatest
  std::optional<Window> own;              ///< what the series asks for
  std::vector<double> shares;             ///< below the n-th are n percent of the voxels; ascending; may be empty
  std::optional<double> light_part = {};  ///< of the body, what is as light as lungs, 0 to 1; unknown for all but HU
};

/// The windows that are offered for the slices. The first is the one shown first: the series' own window. Then follow,
/// for HU, brain, soft tissue, lung and bone; for all other units the middle 98 percent of the values, and all of them.
/// Speeds, where nearly none is negative, are shown from zero to twice those of the first frame: a pulse makes others
/// faster. Never empty.
std::vector<NamedWindow> windows_for(const Values& values);

/// As vtkColorTransferFunction (value, red, green, blue) and vtkPiecewiseFunction (value, opacity, 0.5, 0) take them.
struct VolumeLook {
  const char* name = "";  ///< English, for tr()
  std::vector<double> colors;
  std::vector<double> opacity;
  bool shaded = true;  ///< as by a lamp at the eye
};

/// The looks that are offered for the volume. For HU: CT skin, bone, lung, vessels. For others: MR, which shows what is
/// brighter than the background (Otsu's threshold, from the distribution of the values), and MR vessels, which shows
/// the few percent that are brightest.
std::vector<VolumeLook> volume_looks_for(const Values& values);

/// Which of them suits the scan. For HU: skin; bone if there is no air around the patient; lung if a tenth of the body
/// or more is as light as lungs (counted inside the body, without foam under it, if that is known). For others: vessels
/// if only a few percent are brighter than the background.
std::size_t suited_look(const Values& values);

/// The value that splits the spread best into two classes (Otsu, "A threshold selection method from gray-level
/// histograms", 1979). Needs shares.
double otsu_threshold(const std::vector<double>& shares);

}  // namespace palpate::plugin
