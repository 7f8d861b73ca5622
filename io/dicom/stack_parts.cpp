#include "io/dicom/stack_parts.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <glm/geometric.hpp>
#include <map>
#include <set>
#include <utility>

#include "io/dicom/frames.h"
#include "io/dicom/lattice.h"
#include "io/dicom/stacking.h"
#include "io/messages.h"
#include "io/quantile.h"

namespace palpate::io::internal {
namespace {

using Slice = SeriesSource::Slice;

/// What holds for all images of the stack.
struct Stack {
  const SeriesSource& source;
  const Placement& reference;
  double same_place = 0;  ///< mm
  double thickness = 0;   ///< mm, the slices' usual one; 0 if unknown
  bool is_ct = false;     ///< the table moves on: one acquisition never fills the gaps of another
  double even_step = 0;   ///< mm, of all slices taken together; 0 if they are not evenly spaced

  const Plane& plane(const Slice& slice) const { return source.plane_of(slice); }
  const FileHeader& file(const Slice& slice) const { return source.file_of(slice); }
};

/// Images that a rule does not tell apart.
struct Class {
  std::string name;
  std::vector<Slice> slices;
  Lattice lattice;
};

/// How surely images that a rule tells apart are of different volumes.
enum class Proof {
  different_side,   ///< always
  different_place,  ///< where there are slices of both at a height, or as for different_time
  different_kind,   ///< where their slices interleave
  different_time    ///< where they interleave in a way in which the passes of one acquisition would not
};

struct Rule {
  Proof proof = Proof::different_kind;
  bool may_be_frames = true;  ///< whether two parts may be frames of one volume
  std::size_t least_slices = 3;
  bool by_order = false;  ///< whether it knows nothing but times and numbers, which tie and turn back within one scan
  std::function<std::vector<Class>(const Stack&, const std::vector<Slice>&)> classes;
};

template <typename Value, typename NameOf>
std::vector<Class> by_value(const std::vector<Slice>& slices, const Value& value_of, const NameOf& name_of) {
  std::map<decltype(value_of(slices.front())), std::vector<Slice>> by;
  for (const Slice& slice : slices) by[value_of(slice)].push_back(slice);
  std::vector<Class> classes;
  classes.reserve(by.size());
  for (auto& [value, of_it] : by) classes.push_back({name_of(value, classes.size()), std::move(of_it), {}});
  return classes;
}

std::string stack_name(std::size_t n) {
  return "stack " + std::to_string(n + 1);
}

std::vector<Class> by_label(const Stack& stack, const std::vector<Slice>& slices, Label label) {
  const auto value_of = [&](const Slice& s) { return stack.plane(s).labels[static_cast<std::size_t>(label)]; };
  return by_value(slices, value_of, [&](const std::string& value, std::size_t) { return label_text(label, value); });
}

// Files that hold several slices, each by itself; all that hold one, together.
std::vector<Class> by_file(const Stack& stack, const std::vector<Slice>& slices) {
  std::map<std::uint32_t, std::pair<double, double>> extents;
  for (const Slice& slice : slices) {
    const double height = height_of(stack.plane(slice).placement->position, stack.reference);
    auto& [low, high] = extents.try_emplace(slice.file, height, height).first->second;
    low = std::min(low, height);
    high = std::max(high, height);
  }
  const auto value_of = [&](const Slice& slice) {
    const auto& [low, high] = extents.at(slice.file);
    return high - low > stack.same_place ? std::int64_t{slice.file} : std::int64_t{-1};
  };
  return by_value(slices, value_of, [](std::int64_t, std::size_t n) { return "file " + std::to_string(n + 1); });
}

// Stacks beside each other: their slices' first voxels lie on lines apart. A tilted stack's do not lie on one line
// along the normal; it has as many places as slices.
std::vector<Class> by_place(const Stack& stack, const std::vector<Slice>& slices) {
  const double pixel = std::min(stack.reference.spacing_i, stack.reference.spacing_j);
  const auto place_of = [&](const Slice& slice) {
    const Vec3 from = stack.plane(slice).placement->position - stack.reference.position;
    return std::pair(std::lround(glm::dot(from, stack.reference.direction_i) / (2 * pixel)),
                     std::lround(glm::dot(from, stack.reference.direction_j) / (2 * pixel)));
  };
  std::set<std::pair<long, long>> places;
  for (const Slice& slice : slices) places.insert(place_of(slice));
  constexpr std::size_t most = 8;
  if (places.size() > most) return {};
  return by_value(slices, place_of, [](const auto&, std::size_t n) { return stack_name(n); });
}

/// A time, and the number of the image.
using Turn = std::pair<std::string, double>;

// In the order of their turns, a new stack begins where the slices turn back.
std::vector<Class> runs(const Stack& stack, std::vector<Slice> slices,
                        const std::function<Turn(const Slice&)>& turn_of) {
  std::ranges::stable_sort(slices, {}, turn_of);
  std::vector<Class> classes;
  double last = 0;
  int sense = 0;
  for (const Slice& slice : slices) {
    const double height = height_of(stack.plane(slice).placement->position, stack.reference);
    const double step = height - last;
    const int now = classes.empty() || std::abs(step) <= stack.same_place ? 0 : step > 0 ? 1 : -1;
    if (classes.empty() || (now != 0 && sense != 0 && now != sense)) {
      classes.push_back({stack_name(classes.size()), {}, {}});
      sense = 0;
    } else if (now != 0) {
      sense = now;
    }
    classes.back().slices.push_back(slice);
    last = height;
  }
  return classes;
}

void measure(const Stack& stack, std::vector<Class>& classes) {
  for (Class& c : classes) c.lattice = lattice_of(stack.source, c.slices, stack.reference, stack.same_place);
}

// Too few slices for a stack of their own; a rule's result on a few images may still hold for the others.
bool set_small_apart(std::vector<Class>& classes, std::size_t least, std::vector<Slice>& small) {
  std::size_t all = 0;
  for (const Class& c : classes) all += c.slices.size();
  const auto is_small = [&](const Class& c) { return c.lattice.heights.size() < least; };
  for (const Class& c : classes) {
    if (is_small(c)) small.insert(small.end(), c.slices.begin(), c.slices.end());
  }
  std::erase_if(classes, is_small);
  return classes.size() >= 2 && 5 * small.size() <= all;
}

// By the times themselves if they are a few that many slices share; otherwise by their order.
std::vector<Class> by_time(const Stack& stack, const std::vector<Slice>& slices, std::string FileHeader::*time) {
  const auto value_of = [&](const Slice& s) { return stack.file(s).*time; };
  auto classes = by_value(slices, value_of, [](const auto&, std::size_t n) { return stack_name(n); });
  measure(stack, classes);
  if (std::ranges::all_of(classes, [](const Class& c) { return c.lattice.heights.size() >= 3; })) return classes;
  return runs(stack, slices, [&](const Slice& s) { return Turn(value_of(s), stack.file(s).instance_number); });
}

std::vector<Class> by_number(const Stack& stack, const std::vector<Slice>& slices) {
  return runs(stack, slices, [&](const Slice& s) { return Turn("", stack.file(s).instance_number); });
}

std::vector<Class> by_folder(const Stack& stack, const std::vector<Slice>& slices) {
  return by_value(
      slices, [&](const Slice& s) { return stack.file(s).path.parent_path(); },
      [](const auto&, std::size_t n) { return stack_name(n); });
}

Rule label_rule(Proof proof, Label label, bool may_be_frames) {
  return {proof, may_be_frames, 3, false,
          [label](const Stack& stack, const std::vector<Slice>& slices) { return by_label(stack, slices, label); }};
}

const std::vector<Rule>& rules() {
  static const std::vector<Rule> all = [] {
    std::vector<Rule> r;
    r.push_back(label_rule(Proof::different_side, Label::laterality, false));
    r.push_back({Proof::different_place, false, 2, false, by_place});
    r.push_back({Proof::different_kind, true, 2, false, by_file});
    r.push_back(label_rule(Proof::different_kind, Label::image_type, false));
    r.push_back(label_rule(Proof::different_kind, Label::kernel, false));
    for (const Label label : {Label::echo_time, Label::b_value, Label::velocity_encoding, Label::time_point}) {
      r.push_back(label_rule(Proof::different_kind, label, true));
    }
    for (const Label label : {Label::diffusion_direction, Label::trigger_time, Label::acquisition}) {
      r.push_back(label_rule(Proof::different_time, label, true));
    }
    for (const auto time : {&FileHeader::acquisition_time, &FileHeader::content_time}) {
      r.push_back({Proof::different_time, true, 3, true, [time](const Stack& stack, const std::vector<Slice>& slices) {
                     return by_time(stack, slices, time);
                   }});
    }
    r.push_back({Proof::different_time, true, 3, true, by_number});
    r.push_back({Proof::different_time, true, 3, true, by_folder});
    return r;
  }();
  return all;
}

constexpr double evenly = 0.15;  // of a step

bool is_multiple(double distance, double step) {
  const double times = distance / step;
  return std::round(times) >= 1 && std::abs(times - std::round(times)) <= evenly;
}

// Passes of one acquisition divide its step evenly. Where times tie, there are more or fewer classes than passes: then
// all slices taken together say it.
bool divides_evenly(const Stack& stack, double distance, double step, std::size_t passes) {
  if (stack.even_step > 0 && is_multiple(distance, stack.even_step)) return true;
  return is_multiple(distance, step / static_cast<double>(passes));
}

// The step that nearly all slices have in common; 0 if there is none.
double even_step_of(const Lattice& lattice) {
  std::size_t alike = 0;
  for (std::size_t k = 1; k < lattice.heights.size(); ++k) {
    const double step = lattice.heights[k] - lattice.heights[k - 1];
    if (std::abs(step - lattice.step) <= evenly * lattice.step) ++alike;
  }
  return lattice.heights.size() > 1 && 5 * alike >= 4 * (lattice.heights.size() - 1) ? lattice.step : 0;
}

enum class Verdict { one_stack, two_stacks, unknown };

Verdict judge(const Stack& stack, const Rule& rule, const Class& a, const Class& b, std::size_t passes) {
  if (rule.proof == Proof::different_side) return Verdict::two_stacks;
  const Overlap overlap = overlap_of(a.lattice, b.lattice, stack.same_place);
  if (overlap.slices < 2 || !a.lattice.even || !b.lattice.even) return Verdict::one_stack;
  if (overlap.coincide) {
    // Labels separate frames; parts separated only by an order would be mixed where each extends beyond the other.
    const std::size_t fewer = std::min(a.lattice.heights.size(), b.lattice.heights.size());
    const bool mixed = rule.proof == Proof::different_time && overlap.shifted && 4 * overlap.slices >= fewer;
    return mixed || rule.proof == Proof::different_place ? Verdict::two_stacks : Verdict::one_stack;
  }
  if (rule.proof == Proof::different_kind) return Verdict::two_stacks;
  const double step = std::max(a.lattice.step, b.lattice.step);
  if (!divides_evenly(stack, overlap.distance, step, passes)) return Verdict::two_stacks;
  if (!(stack.thickness > 0)) return stack.is_ct ? Verdict::two_stacks : Verdict::unknown;
  // MR also acquires thick slices in turns: in an evenly filled stack their order does not mean two scans.
  if (rule.by_order && !stack.is_ct && stack.even_step > 0) return Verdict::one_stack;
  // Each is complete by itself, and the slices of one are between those of the other.
  const bool overlaps = overlap.distance < 0.9 * stack.thickness && step < 1.5 * stack.thickness;
  return overlaps ? Verdict::two_stacks : Verdict::one_stack;
}

/// Classes that form one stack, and remaining doubts.
struct Grouped {
  std::vector<std::vector<Class>> groups;
  std::string doubt;
};

Grouped group(const Stack& stack, const Rule& rule, std::vector<Class> classes) {
  Grouped result;
  const std::size_t passes = classes.size();
  for (Class& c : classes) {
    const auto fits = [&](const std::vector<Class>& group) {
      const Class* judged = nullptr;
      for (const Class& other : group) {
        if (judged != nullptr && judged->lattice == other.lattice) continue;  // as the one before: time points
        judged = &other;
        const Verdict verdict = judge(stack, rule, other, c, passes);
        if (verdict == Verdict::two_stacks) return false;
        if (verdict == Verdict::unknown) result.doubt = other.name + " and " + c.name;
      }
      return true;
    };
    const auto found = std::ranges::find_if(result.groups, fits);
    (found == result.groups.end() ? result.groups.emplace_back() : *found).push_back(std::move(c));
  }
  return result;
}

struct Part {
  std::vector<Slice> slices;
  std::string name;
  bool may_be_frame = true;
};

std::string joined_name(const std::vector<Class>& group, std::size_t n) {
  constexpr std::size_t most_named = 3;
  if (group.size() > most_named) return stack_name(n);
  std::string name;
  for (const Class& c : group) name += (name.empty() ? "" : " and ") + c.name;
  return name;
}

bool of_one_file(const std::vector<Slice>& slices) {
  return std::ranges::all_of(slices, [&](const Slice& s) { return s.file == slices.front().file; });
}

// Where labels tell all images of a position apart, their order tells no more.
bool order_matters(const Stack& stack, const std::vector<Slice>& slices) {
  const FrameSplit split = split_into_frames(stack.source, slices);
  return split.frames.size() == 1 || split.ranked;
}

void part(const Stack& stack, Part whole, std::size_t first_rule, std::vector<Part>& parts,
          std::vector<std::string>& doubts) {
  for (std::size_t n = first_rule; n < rules().size(); ++n) {
    const Rule& rule = rules()[n];
    if (rule.proof == Proof::different_time && (of_one_file(whole.slices) || !order_matters(stack, whole.slices)))
      break;
    std::vector<Class> classes = rule.classes(stack, whole.slices);
    constexpr std::size_t most = 1024;
    if (classes.size() < 2 || classes.size() > most) continue;
    measure(stack, classes);
    std::vector<Slice> small;
    if (!set_small_apart(classes, rule.least_slices, small)) continue;
    Grouped grouped = group(stack, rule, std::move(classes));
    if (grouped.groups.size() < 2) {
      if (!grouped.doubt.empty()) doubts.push_back(grouped.doubt);
      continue;
    }
    for (std::size_t g = 0; g < grouped.groups.size(); ++g) {
      Part one{{}, joined_name(grouped.groups[g], g), whole.may_be_frame && rule.may_be_frames};
      if (!whole.name.empty()) one.name = whole.name + ", " + one.name;
      for (const Class& c : grouped.groups[g]) one.slices.insert(one.slices.end(), c.slices.begin(), c.slices.end());
      if (g == 0) one.slices.insert(one.slices.end(), small.begin(), small.end());
      part(stack, std::move(one), n + 1, parts, doubts);
    }
    return;
  }
  parts.push_back(std::move(whole));
}

// A head that moved between two times is followed by its slices.
bool nearly_the_same(const Stack& stack, const Part& a, const Part& b) {
  const Lattice x = lattice_of(stack.source, a.slices, stack.reference, stack.same_place);
  const Lattice y = lattice_of(stack.source, b.slices, stack.reference, stack.same_place);
  return a.may_be_frame && b.may_be_frame && x.heights.size() == y.heights.size() &&
         std::abs(x.heights.front() - y.heights.front()) < 0.25 * x.step &&
         std::abs(x.heights.back() - y.heights.back()) < 0.25 * x.step;
}

double usual_thickness(const SeriesSource& source, const std::vector<Slice>& slices) {
  std::vector<double> all;
  all.reserve(slices.size());
  for (const Slice& slice : slices) all.push_back(source.file_of(slice).thickness);
  return quantile(std::move(all), 0.5);
}

}  // namespace

PartedStack part_stack(const SeriesSource& source, std::vector<Slice> slices) {
  const Placement reference = *source.plane_of(slices.front()).placement;
  const double same_place = same_place_mm(reference);
  const Stack stack{source,
                    reference,
                    same_place,
                    usual_thickness(source, slices),
                    source.file_of(slices.front()).modality == "CT",
                    even_step_of(lattice_of(source, slices, reference, same_place))};
  std::vector<Part> parts;
  std::vector<std::string> undecided;
  part(stack, {std::move(slices), "", true}, 0, parts, undecided);

  PartedStack result;
  std::vector<const Part*> first_of_volume;
  for (const Part& one : parts) {
    const auto like =
        std::ranges::find_if(first_of_volume, [&](const Part* p) { return nearly_the_same(stack, *p, one); });
    const auto volume = static_cast<int>(like - first_of_volume.begin());
    if (like == first_of_volume.end()) first_of_volume.push_back(&one);
    result.parts.push_back({one.slices, parts.size() > 1 ? one.name : std::string(), volume});
  }
  for (const std::string& what : undecided) {
    result.doubts.push_back(say("slices-lie-by-turns", what));
  }
  return result;
}

}  // namespace palpate::io::internal
