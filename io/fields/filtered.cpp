#include "io/fields/filtered.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>
#include <limits>
#include <opencv2/core.hpp>
#include <stdexcept>
#include <utility>

#include "io/errors.h"
#include "io/fields/filters/gaussian_weights.h"
#include "io/messages.h"
#include "io/parallel.h"

namespace palpate::io {
namespace {

constexpr int block = 16;  // slices computed at once

std::size_t voxels_in_slice(const Volume& v) {
  return static_cast<std::size_t>(v.geometry.dimensions.x) * static_cast<std::size_t>(v.geometry.dimensions.y);
}

/// Rescaled values of a slice. Padding and values that are not finite are replaced by the smallest of the others.
/// `left_out` marks them; empty if there are none.
struct Slice {
  cv::Mat values;         // CV_32F
  cv::Mat left_out;       // CV_8U, 255 where a voxel is
  bool is_empty = false;  ///< all of it is left out
};

Slice read_slice(const Volume& v, int k) {
  const glm::ivec3 size = v.geometry.dimensions;
  Slice slice{cv::Mat(size.y, size.x, CV_32F), {}};
  if (v.padding) slice.left_out = cv::Mat::zeros(size.y, size.x, CV_8U);
  float least = std::numeric_limits<float>::max();
  for (int j = 0; j < size.y; ++j) {
    auto* const row = slice.values.ptr<float>(j);
    for (int i = 0; i < size.x; ++i) {
      row[i] = static_cast<float>(v.value_at(i, j, k));
      const bool is_finite = std::isfinite(row[i]);
      if (v.is_padding(i, j, k) || !is_finite) {
        if (slice.left_out.empty()) slice.left_out = cv::Mat::zeros(size.y, size.x, CV_8U);
        slice.left_out.at<unsigned char>(j, i) = 255;
        if (!is_finite) row[i] = 0;  // where nothing else is there
      } else {
        least = std::min(least, row[i]);
      }
    }
  }
  slice.is_empty = least == std::numeric_limits<float>::max();
  if (!slice.is_empty && !slice.left_out.empty()) slice.values.setTo(least, slice.left_out);
  return slice;
}

/// How far slice m lies from slice k along the steps, mm.
double apart_mm(const Geometry& g, int k, int m) {
  return glm::length(g.slice_positions[static_cast<std::size_t>(m)] - g.slice_positions[static_cast<std::size_t>(k)]);
}

/// The slices that a Gaussian at slice k reaches, both ends included; not across a gap.
std::pair<int, int> reached(const Geometry& g, int k, double sigma_mm) {
  const auto is_gap = [&](int from) { return std::ranges::binary_search(g.gaps, from); };
  int first = k, last = k;
  while (first > 0 && !is_gap(first - 1) && apart_mm(g, k, first - 1) <= internal::gaussian_reach * sigma_mm) --first;
  while (last + 1 < g.dimensions.z && !is_gap(last) && apart_mm(g, k, last + 1) <= internal::gaussian_reach * sigma_mm)
    ++last;
  return {first, last};
}

/// The part of the stack that a slice represents, mm: half of the way to its neighbors.
double share_mm(const Geometry& g, int k) {
  const int before = std::max(k - 1, 0), after = std::min(k + 1, g.dimensions.z - 1);
  return before == after ? 1 : apart_mm(g, before, after) / (after - before);
}

/// Along the steps, of slices that were filtered in themselves: `slice(m)` is such a one. Those that are empty add
/// nothing.
template <typename SliceAt>
cv::Mat gaussian_across(const Geometry& g, int k, double sigma_mm, const SliceAt& slice) {
  const auto [first, last] = reached(g, k, sigma_mm);
  if (first == last || slice(k).is_empty) return slice(k).values.clone();
  cv::Mat sum = cv::Mat::zeros(slice(k).values.size(), CV_64F);
  double all = 0;
  for (int m = first; m <= last; ++m) {
    if (slice(m).is_empty) continue;
    const double away = apart_mm(g, k, m) / sigma_mm;
    const double weight = share_mm(g, m) * std::exp(-0.5 * away * away);
    cv::Mat wide;
    slice(m).values.convertTo(wide, CV_64F);
    cv::scaleAdd(wide, weight, sum, sum);
    all += weight;
  }
  cv::Mat result;
  sum.convertTo(result, CV_32F, 1 / all);
  return result;
}

using PaddingRange = std::optional<std::pair<double, double>>;

/// The padding's range among rescaled floats.
PaddingRange rescaled_padding(const Volume& v) {
  if (!v.padding) return std::nullopt;
  const auto rescaled = [&](double stored) {
    return static_cast<double>(static_cast<float>(v.slope * stored + v.intercept));
  };
  const double one = rescaled(v.padding->first), other = rescaled(v.padding->second);
  return std::pair{std::min(one, other), std::max(one, other)};
}

/// Restores the voxels that were left out, and keeps the others from becoming padding.
void keep_left_out(const Volume& v, int k, const cv::Mat& left_out, const PaddingRange& range, cv::Mat& values) {
  if (!range && left_out.empty()) return;
  const auto above =
      std::nextafter(range ? static_cast<float>(range->second) : 0.0F, std::numeric_limits<float>::max());
  for (int j = 0; j < values.rows; ++j) {
    auto* const row = values.ptr<float>(j);
    for (int i = 0; i < values.cols; ++i) {
      if (!left_out.empty() && left_out.at<unsigned char>(j, i) != 0) {
        row[i] = static_cast<float>(v.value_at(i, j, k));
      } else if (range && row[i] >= range->first && row[i] <= range->second) {
        row[i] = above;
      }
    }
  }
}

}  // namespace

std::vector<float> filtered_slices(const Volume& raw, const Filter& filter, int first, int last) {
  const Geometry& g = raw.geometry;
  const bool across = filter.type->reaches_across;
  const int from = across ? reached(g, first, filter.sigma_mm).first : first;
  const int to = across ? reached(g, last, filter.sigma_mm).second : last;
  std::vector<Slice> slices;
  slices.reserve(static_cast<std::size_t>(to - from) + 1);
  for (int k = from; k <= to; ++k) {
    Slice slice = read_slice(raw, k);
    slice.values = filter.type->in_slice(slice.values, g, filter);
    slices.push_back(std::move(slice));
  }
  const auto at = [&](int k) -> const Slice& { return slices[static_cast<std::size_t>(k - from)]; };
  const PaddingRange padding = rescaled_padding(raw);
  const std::size_t stride = voxels_in_slice(raw);
  std::vector<float> result(stride * (static_cast<std::size_t>(last - first) + 1));
  for (int k = first; k <= last; ++k) {
    cv::Mat values = across ? gaussian_across(g, k, filter.sigma_mm, at) : at(k).values;
    keep_left_out(raw, k, at(k).left_out, padding, values);
    std::memcpy(&result[static_cast<std::size_t>(k - first) * stride], values.ptr<float>(), stride * sizeof(float));
  }
  return result;
}

std::shared_ptr<const Volume> raw_of(const std::shared_ptr<const Volume>& volume) {
  return volume && volume->filtered_from ? volume->filtered_from->raw : volume;
}

Filter filter_of(const Volume& volume) {
  return volume.filtered_from ? volume.filtered_from->filter : Filter{};
}

std::shared_ptr<const Volume> filtered(const std::shared_ptr<const Volume>& volume, const Filter& filter,
                                       const Progress& progress) {
  std::shared_ptr<const Volume> raw = raw_of(volume);
  if (filter.type == nullptr) return raw;
  validate(filter);
  if (filter_of(*volume) == filter) return volume;
  if (raw->vectors) {
    throw InvalidInput(say("velocity-is-not-filtered"));
  }
  auto result = std::make_shared<Volume>();
  result->geometry = raw->geometry;
  result->unit = raw->unit;
  result->frame_of_reference_uid = raw->frame_of_reference_uid;
  result->modality = raw->modality;
  result->body_part = raw->body_part;
  result->description = raw->description;
  result->patient_id = raw->patient_id;
  result->patient_name = raw->patient_name;
  result->warnings = raw->warnings;
  result->padding = rescaled_padding(*raw);
  result->filtered_from = std::make_shared<const FilteredFrom>(FilteredFrom{.filter = filter, .raw = raw});
  const int slices = raw->geometry.dimensions.z;
  const std::size_t stride = voxels_in_slice(*raw);
  std::vector<float> values(stride * static_cast<std::size_t>(slices));
  internal::parallel_for(
      static_cast<std::size_t>((slices + block - 1) / block),
      [&](std::size_t n) {
        const int first = static_cast<int>(n) * block;
        const int last = std::min(first + block, slices) - 1;
        const std::vector<float> part = filtered_slices(*raw, filter, first, last);
        std::memcpy(&values[static_cast<std::size_t>(first) * stride], part.data(), part.size() * sizeof(float));
      },
      progress, 0);
  result->voxels = std::move(values);
  return result;
}

}  // namespace palpate::io
