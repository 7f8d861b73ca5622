#include "io/dicom/frames.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <map>
#include <optional>
#include <set>
#include <tuple>

#include "io/dicom/stacking.h"

namespace palpate::io::internal {
namespace {

using Slice = SeriesSource::Slice;
using Positions = std::vector<std::vector<Slice>>;

std::optional<double> frame_number_in(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  return error == std::errc() && end == text.data() + text.size() ? std::optional(value) : std::nullopt;
}

// The values of a label in the order of their frames: numbers ascending, words (kinds of image) as acquired.
std::vector<std::string> ordered_values(const SeriesSource& source, const Positions& positions, std::size_t label) {
  std::vector<std::string> values;
  for (const auto& position : positions) {
    for (const Slice& slice : position) {
      const std::string& value = source.plane_of(slice).labels[label];
      if (std::find(values.begin(), values.end(), value) == values.end()) values.push_back(value);
    }
  }
  if (std::all_of(values.begin(), values.end(), [](const auto& v) { return frame_number_in(v).has_value(); })) {
    std::sort(values.begin(), values.end(),
              [](const auto& a, const auto& b) { return *frame_number_in(a) < *frame_number_in(b); });
  }
  return values;
}

Positions gather_positions(const SeriesSource& source, std::vector<Slice> slices) {
  const Placement& reference = *source.plane_of(slices.front()).placement;
  const auto height = [&](const Slice& s) { return height_of(source.plane_of(s).placement->position, reference); };
  // Unreadable copies last, so that they never displace a good one; then as acquired.
  const auto order = [&](const Slice& s) {
    const FileHeader& file = source.file_of(s);
    return std::tuple(!file.defect.empty(), file.acquisition_time, file.content_time, file.instance_number, s.file,
                      s.plane);
  };
  std::stable_sort(slices.begin(), slices.end(), [&](const Slice& a, const Slice& b) { return height(a) < height(b); });
  const double same_place = same_place_mm(reference);
  Positions positions;
  double last = 0;
  for (const Slice& slice : slices) {
    const double here = height(slice);
    if (positions.empty() || here - last > same_place) positions.emplace_back();
    positions.back().push_back(slice);
    last = here;
  }
  for (auto& position : positions) {
    std::sort(position.begin(), position.end(), [&](const Slice& a, const Slice& b) { return order(a) < order(b); });
  }
  return positions;
}

// A label makes frames where it takes few values and each of them at half of the positions or more: an acquisition
// number that merely grows along the stack does not.
std::vector<std::size_t> telling_labels(const SeriesSource& source, const Positions& positions) {
  std::size_t most = 0;
  for (const auto& position : positions) most = std::max(most, position.size());
  std::vector<std::size_t> telling;
  if (most < 2) return telling;  // nothing repeats
  for (std::size_t label = 0; label < label_count; ++label) {
    std::map<std::string, std::size_t> positions_with;
    for (const auto& position : positions) {
      std::set<std::string> here;
      for (const Slice& slice : position) here.insert(source.plane_of(slice).labels[label]);
      for (const auto& value : here) ++positions_with[value];
    }
    const bool everywhere = std::all_of(positions_with.begin(), positions_with.end(),
                                        [&](const auto& value) { return 2 * value.second >= positions.size(); });
    if (positions_with.size() >= 2 && positions_with.size() <= most && everywhere) telling.push_back(label);
  }
  return telling;
}

// Images of a position that have different keys, over all positions.
std::size_t told_apart(const SeriesSource& source, const Positions& positions, const std::vector<std::size_t>& labels) {
  std::size_t count = 0;
  for (const auto& position : positions) {
    std::set<std::vector<std::string>> keys;
    for (const Slice& slice : position) {
      std::vector<std::string> key;
      key.reserve(labels.size());
      for (const std::size_t label : labels) key.push_back(source.plane_of(slice).labels[label]);
      keys.insert(std::move(key));
    }
    count += keys.size();
  }
  return count;
}

// Only labels that add information to those before them: acquisition numbers that alternate from slice to slice would
// divide frames that an echo time already separates.
std::vector<std::size_t> dividing_labels(const SeriesSource& source, const Positions& positions,
                                         const std::vector<std::size_t>& telling) {
  std::vector<std::size_t> dividing;
  std::size_t count = positions.size();
  for (const std::size_t label : telling) {
    dividing.push_back(label);
    const std::size_t with_it = told_apart(source, positions, dividing);
    if (with_it == count) dividing.pop_back();
    count = with_it;
  }
  return dividing;
}

// Places where half of the frames or more have a slice, ascending.
template <typename PlacesOfFrames>
std::vector<std::size_t> usual_places(const PlacesOfFrames& places, std::size_t count) {
  std::vector<std::size_t> held(count), usual;
  for (const auto& [key, of_frame] : places) {
    for (const std::size_t place : of_frame) ++held[place];
  }
  for (std::size_t place = 0; place < count; ++place) {
    if (2 * held[place] >= places.size()) usual.push_back(place);
  }
  return usual;
}

std::vector<Vec3> lacking_of(const SeriesSource& source, const Positions& positions,
                             const std::vector<std::size_t>& usual, const std::vector<std::size_t>& present) {
  std::vector<Vec3> lacking;
  for (const std::size_t place : usual) {
    if (std::ranges::binary_search(present, place)) continue;
    lacking.push_back(source.plane_of(positions[place].front()).placement->position);
  }
  return lacking;
}

// What all of a frame has in common and other frames have not.
std::string name_of(const SeriesSource& source, const std::vector<Slice>& frame,
                    const std::vector<std::size_t>& telling, std::size_t rank, bool ranked) {
  std::string name;
  for (const std::size_t label : telling) {
    const auto value_of = [&](const Slice& slice) { return source.plane_of(slice).labels[label]; };
    const std::string value = value_of(frame.front());
    const bool common = std::all_of(frame.begin(), frame.end(), [&](const Slice& s) { return value_of(s) == value; });
    if (value.empty() || !common) continue;
    name += (name.empty() ? "" : ", ") + label_text(static_cast<Label>(label), value);
  }
  if (ranked) name += (name.empty() ? "image " : ", image ") + std::to_string(rank + 1);
  return name;
}

}  // namespace

std::string label_text(Label label, const std::string& value) {
  static constexpr std::array before{"",           "kernel ",         "side ",       "echo time ",     "b = ",
                                     "direction ", "velocity along ", "time point ", "trigger delay ", "acquisition "};
  static constexpr std::array after{"", "", "", " ms", " s/mm2", "", "", "", " ms", ""};
  static_assert(before.size() == label_count && after.size() == label_count);
  const auto n = static_cast<std::size_t>(label);
  std::string text = before.at(n) + value + after.at(n);
  std::replace(text.begin(), text.end(), '\\', ' ');
  return text;
}

FrameSplit split_into_frames(const SeriesSource& source, std::vector<Slice> slices) {
  FrameSplit split;
  if (slices.empty()) return split;
  const Positions positions = gather_positions(source, std::move(slices));
  const auto telling = telling_labels(source, positions);
  const auto dividing = dividing_labels(source, positions, telling);

  std::vector<std::vector<std::string>> values;
  values.reserve(dividing.size());
  for (const std::size_t label : dividing) values.push_back(ordered_values(source, positions, label));
  // A frame's key: the place of its value of each dividing label, then its rank among images that these do not tell
  // apart.
  std::map<std::vector<std::size_t>, std::vector<Slice>> frames;
  std::map<std::vector<std::size_t>, std::vector<std::size_t>> places;  // where each frame has a slice, ascending
  for (std::size_t place = 0; place < positions.size(); ++place) {
    const auto& position = positions[place];
    std::map<std::vector<std::size_t>, std::size_t> seen;
    for (const Slice& slice : position) {
      std::vector<std::size_t> key;
      for (std::size_t i = 0; i < dividing.size(); ++i) {
        const auto value = std::find(values[i].begin(), values[i].end(), source.plane_of(slice).labels[dividing[i]]);
        key.push_back(static_cast<std::size_t>(value - values[i].begin()));
      }
      const std::size_t rank = seen[key]++;
      key.push_back(rank);
      places[key].push_back(place);
      frames[std::move(key)].push_back(slice);
    }
  }

  std::size_t largest = 0;
  for (const auto& [key, frame] : frames) largest = std::max(largest, frame.size());
  const auto is_frame = [&](const auto& entry) { return 2 * entry.second.size() > largest || frames.size() == 1; };
  split.ranked =
      std::any_of(frames.begin(), frames.end(), [&](const auto& f) { return f.first.back() > 0 && is_frame(f); });
  std::erase_if(places, [&](const auto& entry) { return !is_frame(*frames.find(entry.first)); });
  const std::vector<std::size_t> usual = usual_places(places, positions.size());
  for (auto& entry : frames) {
    if (is_frame(entry)) {
      split.lacking.push_back(lacking_of(source, positions, usual, places[entry.first]));
      split.names.push_back(name_of(source, entry.second, telling, entry.first.back(), split.ranked));
      split.frames.push_back(std::move(entry.second));
    } else {
      split.left_over.insert(split.left_over.end(), entry.second.begin(), entry.second.end());
    }
  }
  return split;
}

}  // namespace palpate::io::internal
