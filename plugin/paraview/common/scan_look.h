#pragma once

/// The initial appearance of a scan: gray windows for its slices, colors and opacity for its volume, chosen by modality
/// and distribution of values.

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
  bool speeds = false;         ///< whether they are in m/s
  double low = 0;              ///< least
  double high = 1;             ///< greatest
  std::optional<Window> own;   ///< the series' own
  std::vector<double> shares;  ///< percentiles: n percent of the voxels are below the n-th; ascending; may be empty
  std::optional<double> light_part = {};  ///< fraction of the body that is as light as lungs, 0 to 1; only for HU
};

/// The windows offered for the slices. The first of them is used first: the series' own window, if there is one. Then,
/// for HU, brain, soft tissue, lung and bone; for all other units the middle 98 percent of the values, and all of them.
/// Speeds that are hardly ever negative are shown from zero to twice those of the first frame, because a pulse makes
/// other frames faster. Never empty.
std::vector<NamedWindow> windows_for(const Values& values);

/// In the form of vtkColorTransferFunction (value, red, green, blue) and vtkPiecewiseFunction (value, opacity, 0.5, 0).
struct VolumeLook {
  const char* name = "";  ///< English, for tr()
  std::vector<double> colors;
  std::vector<double> opacity;
  bool shaded = true;  ///< lit from the viewpoint
};

/// The appearances offered for the volume. For HU: CT skin, bone, lung, vessels. For others: MR, which shows everything
/// brighter than the background (Otsu's threshold, from the distribution of the values), and MR vessels, which shows
/// the brightest few percent.
std::vector<VolumeLook> volume_looks_for(const Values& values);

/// The index of the most suitable one. For HU: skin; bone if there is no air around the patient; lung if at least a
/// tenth of the body is as light as lungs (counted inside the body, without foam under it, if that is known). For
/// others: vessels if only a few percent are brighter than the background.
std::size_t suited_look(const Values& values);

/// The value that best splits the distribution into two classes (Otsu, "A threshold selection method from gray-level
/// histograms", 1979). Needs shares.
double otsu_threshold(const std::vector<double>& shares);

}  // namespace palpate::plugin
