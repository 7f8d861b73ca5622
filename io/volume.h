#pragma once

/// The voxels of one series (of one frame, if positions repeat), in patient space.

#include <array>
#include <cstddef>
#include <cstdint>
#include <glm/mat3x3.hpp>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "io/filter.h"
#include "io/geometry.h"
#include "solver/text/message.h"

namespace palpate::io {

struct FilteredFrom;
struct VectorComponents;

/// value = slope * stored + intercept, in `unit`.
///
/// Voxels are kept as stored (16 bit) if one rescale holds for the whole series. If it differs from slice to slice,
/// they are rescaled floats, with slope 1 and intercept 0.
struct Volume {
  using Voxels = std::variant<std::vector<std::int16_t>, std::vector<std::uint16_t>, std::vector<float>>;

  Geometry geometry;
  Voxels voxels;  ///< dimensions.x * dimensions.y * dimensions.z, i fastest, then j, then k
  double slope = 1;
  double intercept = 0;
  std::string unit;                    ///< "HU", or empty if the modality has none
  std::string frame_of_reference_uid;  ///< empty if unknown
  std::string modality;                ///< DICOM Modality: "CT", "MR", ...
  std::string body_part,
      description;  ///< BodyPartExamined, SeriesDescription: used to choose the starting scene
  /// The patient, to be compared with the structures' patient. Never written or shown.
  std::string patient_id, patient_name;
  /// Stored values, both ends included, that are padding and not tissue (PixelPaddingValue, PixelPaddingRangeLimit).
  std::optional<std::pair<double, double>> padding;
  /// What load() had to leave out, in words for the user.
  std::vector<Text> warnings;
  /// The vectors of a vector field, whose values are then the vectors' lengths. Null for all other volumes.
  std::shared_ptr<const VectorComponents> vectors;
  /// The filter that made the values (fields/filtered.h). Null for a scan as it was stored.
  std::shared_ptr<const FilteredFrom> filtered_from;

  std::size_t offset(int i, int j, int k) const noexcept {
    return (static_cast<std::size_t>(k) * static_cast<std::size_t>(geometry.dimensions.y) +
            static_cast<std::size_t>(j)) *
               static_cast<std::size_t>(geometry.dimensions.x) +
           static_cast<std::size_t>(i);
  }
  /// The rescaled value of a voxel. The index must be inside the volume.
  double value_at(int i, int j, int k) const noexcept;
  bool is_padding(int i, int j, int k) const noexcept;
};

/// A filter and its input.
struct FilteredFrom {
  Filter filter;
  std::shared_ptr<const Volume> raw;
};

/// A vector field as it was measured: one volume for each of three directions, all on the same grid.
///
/// vector = to_patient * (value of along[0], of along[1], of along[2]), along patient axes, in the volumes' unit.
struct VectorComponents {
  std::array<std::shared_ptr<const Volume>, 3> along;
  glm::dmat3 to_patient{1};
};

/// Statistics of the rescaled values of all voxels. They include padding if the voxels are kept as stored (16 bit).
struct Statistics {
  double minimum = 0;
  double maximum = 0;
  double mean = 0;
  std::uint64_t count = 0;  ///< voxels
};

/// The sums are exact for 16-bit voxels. All are zero for a volume without values. Runs on all cores; the result does
/// not depend on their number.
Statistics statistics(const Volume& volume);
/// The same, without padding.
Statistics statistics_without_padding(const Volume& volume);
/// The statistics of both sets of voxels together.
Statistics merge(const Statistics& a, const Statistics& b) noexcept;

}  // namespace palpate::io
