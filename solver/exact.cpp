#include "solver/exact.h"

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>

#include "solver/certify.h"
#include "solver/exact/answer.h"
#include "solver/exact/scratch.h"
#include "solver/exact/walk.h"

namespace palpate::solver {

using internal::FineVec3;
using internal::ForceRegion;
using internal::length_of;
using internal::Placed;

namespace {

constexpr std::size_t none_there = ~std::size_t{0};
constexpr double infinity = std::numeric_limits<double>::infinity();

// One balance and its walks; keeps the best of what they find.
class Search {
 public:
  Search(const Balance& balance, std::span<Vec3> forces, ExactScratch::Arrays& arrays, int cap);

  Solution run(Start start);

 private:
  void start_from_forces();
  void start_from_sweep();
  void sweep();
  std::size_t start_at_common_position();
  void take_as_given();
  void set_columns();
  void make_general();
  bool walk(int cap, bool anyway = false);
  bool walk_as_given(Start start);
  bool walk_apart();
  void consider();
  void refuse_unmet();

  const Balance& balance_;
  std::span<Vec3> forces_;
  std::span<Placed> placed_;
  std::span<Placed> moved_;
  internal::Columns& columns_;
  internal::Walk walk_;
  Solution solution_;
  int cap_;
  double bound_ = infinity;   // of the best answer, whatever stood for infinity
  double hard_strength_ = 0;  // N: what stands for infinity; 0 where nothing is hard
  double extent_ = 0;         // m: of the start
  bool is_swept_ = false;     // whether the end of the sweep, below, is known
  FineVec3 swept_;
  internal::ActiveSet swept_active_;
  double swept_extent_ = 0;
};

Search::Search(const Balance& balance, std::span<Vec3> forces, ExactScratch::Arrays& arrays, int cap)
    : balance_(balance), forces_(forces), columns_(arrays.columns), cap_(cap) {
  const std::size_t n = balance.primitives.size();
  arrays.fit(n);
  placed_ = std::span(arrays.placed).first(n);
  moved_ = std::span(arrays.moved).first(n);
  walk_.stiffness = balance.stiffness;
  walk_.forces = std::span(arrays.forces).first(n);
  walk_.hold = std::span(arrays.hold).first(n);
  walk_.met = std::span(arrays.met).first(n);
  solution_.solver = &exact_solver;
  solution_.outcome = Outcome::capped;
  solution_.error_bound = infinity;
  double force = 0;
  double largest = 0;
  bool hard = false;
  for (std::size_t i = 0; i < n; ++i) {
    Placed& placed = placed_[i];
    internal::place(balance.primitives[i], balance.probe, placed);
    if (placed.type == PrimitiveType::directed_force) {
      walk_.forces[i] = placed.direction * placed.strength;
      walk_.pull += walk_.forces[i];
      force += placed.strength;
    } else {
      largest = std::max(largest, internal::size_of(placed.offset));
      hard = hard || std::isinf(placed.strength);
      force += std::isinf(placed.strength) ? 0 : placed.strength;
    }
  }
  if (hard) {
    // More than any multiplier of a well-conditioned balance; raised where that is not enough.
    hard_strength_ = 0x1p30 * (force + balance.stiffness * largest + 1e-100);
  }
}

// Where the forces given would put the proxy, locked to what they do not exhaust.
void Search::start_from_forces() {
  Vec3 sum = walk_.pull;
  walk_.active = {};
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    const Placed& placed = placed_[i];
    if (placed.type == PrimitiveType::directed_force) {
      continue;
    }
    ForceRegion hold;
    const Vec3 force = internal::project(placed, forces_[i], hold);
    sum += force;
    if (hold == ForceRegion::held && length_of(force) < placed.strength * (1 - 1e-12) && force != Vec3{0}) {
      lock(walk_.active, placed_, static_cast<std::uint32_t>(i));
    }
  }
  walk_.z = internal::fine(sum / balance_.stiffness);
  extent_ = length_of(sum) / balance_.stiffness;
}

// Where one pass of proximal steps ends: the analytical solver without its conditions.
void Search::start_from_sweep() {
  if (!is_swept_) {
    sweep();
    swept_ = walk_.z;
    swept_active_ = walk_.active;
    swept_extent_ = extent_;
    is_swept_ = true;
  }
  walk_.z = swept_;
  walk_.active = swept_active_;
  extent_ = swept_extent_;
}

void Search::sweep() {
  Vec3 z = walk_.pull / balance_.stiffness;
  walk_.active = {};
  for (const PrimitiveType type : {PrimitiveType::plane, PrimitiveType::line, PrimitiveType::point}) {
    for (std::size_t i = 0; i < placed_.size(); ++i) {
      const Placed& placed = placed_[i];
      if (placed.type != type) {
        continue;
      }
      ForceRegion hold;
      const Vec3 step = internal::project(placed, (placed.offset.hi() - z) * balance_.stiffness, hold);
      if (hold == ForceRegion::held && step != Vec3{0}) {
        if (type != PrimitiveType::plane) {
          walk_.active = {};
        }
        lock(walk_.active, placed_, static_cast<std::uint32_t>(i));
      }
      z += step / balance_.stiffness;
    }
  }
  walk_.z = internal::fine(z);
  extent_ = length_of(z);
}

// Where most constraints are, if more than one: from there, if it is all of them, the way to the proxy is straight.
// Returns how many of them are elsewhere, or none_there.
std::size_t Search::start_at_common_position() {
  constexpr std::size_t enough = 32;  // of a balance of more the first are asked
  const std::size_t n = std::min(placed_.size(), enough);
  const auto acts = [](const Placed& placed) {
    return placed.type != PrimitiveType::directed_force && placed.strength > 0;
  };
  std::size_t most = 0;
  std::size_t acting = 0;
  for (std::size_t i = 0; i < n && 2 * most < n; ++i) {
    std::size_t there = 0;
    for (std::size_t j = i; acts(placed_[i]) && j < n; ++j) {
      there += acts(placed_[j]) && internal::size_of(placed_[i].offset - placed_[j].offset) <= 1e-30 ? 1 : 0;
    }
    if (there > most) {
      most = there;
      walk_.z = placed_[i].offset;
      walk_.active = {};
    }
  }
  for (const Placed& placed : placed_) {
    acting += acts(placed) ? 1 : 0;
  }
  return most > 1 || most == acting ? acting - most : none_there;
}

void Search::take_as_given() {
  if (hard_strength_ == 0) {
    walk_.primitives = placed_;
    set_columns();
    return;
  }
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    moved_[i] = placed_[i];
    moved_[i].strength = std::min(moved_[i].strength, hard_strength_);
  }
  walk_.primitives = moved_;
  set_columns();
}

void Search::set_columns() {
  if (walk_.primitives.size() > internal::most_unsorted) {
    columns_.take(walk_.primitives);
    walk_.columns = &columns_;
  }
}

// Moves every primitive by less than half an ulp, each its own way, so that no more of them meet than have to. Hard
// constraints stay, for they might no longer have a common point; hard planes yield.
void Search::make_general() {
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    Placed& moved = moved_[i];
    moved = placed_[i];
    moved.strength = hard_strength_ > 0 ? std::min(moved.strength, hard_strength_) : moved.strength;
    if (moved.type == PrimitiveType::directed_force) {
      continue;
    }
    const double distance = 0x1p-54 * (length_of(moved.offset.hi()) + extent_) + 1e-45;
    const auto bits = (static_cast<std::uint64_t>(i) + 1) * 0x9e3779b97f4a7c15;
    const auto part = [bits](int shift) {
      return static_cast<double>((bits >> shift) & 0xfff) * 0x1p-12 - 0x1.0018p-1;
    };
    const Vec3 way{part(52), part(40), part(28)};
    if (!std::isinf(placed_[i].strength)) {
      moved.offset = moved.offset + way * distance;
    } else if (moved.type == PrimitiveType::plane) {
      moved.offset = moved.offset + moved.direction * (std::abs(way.x) * -distance);
    }
  }
  walk_.primitives = moved_;
  set_columns();
}

// True where the walk's end is the answer. anyway: looks at it though the walk has not arrived.
bool Search::walk(int cap, bool anyway) {
  solution_.iterations += internal::descend(walk_, cap);
  if (walk_.arrived || anyway) {
    consider();
  }
  return solution_.outcome == Outcome::solved;
}

void Search::consider() {
  internal::Settled settled = internal::settle_on(walk_.active, placed_, balance_.stiffness, walk_.z, walk_.forces);
  const double promise = promised_accuracy(balance_, balance_.probe + settled.z.hi(), walk_.forces);
  // Of many primitives what is left may be the rounding of their sum alone, which no other flat takes away.
  const bool is_rounding = walk_.columns != nullptr && settled.bound.slack == 0;
  if (!(settled.bound.error <= 0.05 * promise) && !(is_rounding && settled.bound.error <= promise)) {
    const internal::PlacedPrimitives primitives = placed_.empty()
                                                      ? internal::PlacedPrimitives(balance_.primitives, balance_.probe)
                                                      : internal::PlacedPrimitives(placed_);
    const internal::Settled snapped = internal::settle_and_bound(primitives, balance_.stiffness, walk_.z, walk_.forces);
    settled = snapped.bound.error < settled.bound.error ? snapped : settled;
  }
  if (!(settled.bound.error < bound_) && bound_ < infinity) {
    return;
  }
  bound_ = settled.bound.error;
  std::copy(walk_.forces.begin(), walk_.forces.end(), forces_.begin());
  internal::write_answer(balance_, settled, solution_);
  if (settled.bound.backward_error <= promise) {
    solution_.outcome = Outcome::solved;
  }
}

// The hard constraint that the best answer is furthest from, if that is further than the tolerance.
void Search::refuse_unmet() {
  const FineVec3 z = internal::exact_difference(solution_.proxy, balance_.probe);
  double size = internal::size_of(z);
  double furthest = 0;
  std::size_t index = 0;
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    const Placed& placed = placed_[i];
    if (!std::isinf(placed.strength)) {
      continue;
    }
    size = std::max(size, length_of(placed.offset.hi()));
    const double distance =
        placed.type == PrimitiveType::plane ? internal::depth_of(placed, z).value : internal::miss_of(placed, z).length;
    if (distance > furthest) {
      furthest = distance;
      index = i;
    }
  }
  if (furthest > hard_tolerance * size) {
    solution_.outcome = Outcome::refused;
    solution_.rejection = Rejection{index, Field::strength, Flaw::incompatible, furthest};
  }
}

bool Search::walk_as_given(Start start) {
  constexpr int few_iterations = 30;
  walk_.coarseness = 0x1p-51;
  take_as_given();
  // Where the analytical solver's pass ends, one look is enough if that is the answer.
  const std::size_t elsewhere = start_at_common_position();
  start_from_sweep();
  if (walk(1, elsewhere == 0)) {
    return true;
  }
  if (start == Start::warm) {
    start_from_forces();
    if (walk(few_iterations)) {
      return true;
    }
  }
  if (elsewhere == 0) {
    start_at_common_position();
    if (walk(few_iterations)) {
      return true;
    }
  }
  start_from_sweep();
  if (walk(few_iterations)) {
    return true;
  }
  if (elsewhere == 0 || elsewhere == none_there) {
    return false;
  }
  start_at_common_position();
  return walk(few_iterations);
}

// In general position, and from there as given, to the last digits.
bool Search::walk_apart() {
  walk_.coarseness = 0;
  make_general();
  if (walk(cap_, true)) {
    return true;
  }
  take_as_given();
  return walk(30, true);
}

Solution Search::run(Start start) {
  // The first look is at these, and not at those of an earlier balance.
  for (std::size_t i = 0; i < placed_.size(); ++i) {
    if (placed_[i].type == PrimitiveType::directed_force) continue;
    walk_.forces[i] = start == Start::warm ? forces_[i] : Vec3{0};
  }
  while (!walk_as_given(start) && !walk_apart() && hard_strength_ > 0 && hard_strength_ < 1e60) {
    hard_strength_ *= 0x1p30;
    start = Start::cold;
  }
  if (solution_.outcome != Outcome::solved && hard_strength_ > 0) {
    refuse_unmet();
  }
  return solution_;
}

}  // namespace

Solution solve_exact(const Balance& balance, std::span<Vec3> forces, ExactScratch& scratch,
                     const RunOptions& options) noexcept {
  const int cap = options.max_iterations > 0 ? options.max_iterations : 400;
  ExactScratch::Arrays& arrays = scratch.arrays();
  if (balance.primitives.size() <= internal::most_unsorted) {
    return Search(balance, forces, arrays, cap).run(options.start);
  }
  arrays.fit(balance.primitives.size());
  const Balance sorted = arrays.sorted.take(balance, forces);
  Solution solution = Search(sorted, arrays.sorted.forces(), arrays, cap).run(options.start);
  arrays.sorted.give_back(forces, solution);
  return solution;
}

const SolverType exact_solver{
    .name = "exact",
    .number = 2,
    .summary = "walks down the energy from flat to flat: exact for any finite set of primitives",
    .is_usual = true,
    .reads_forces = true,
    .make_scratch = [](std::size_t primitives) -> std::unique_ptr<Scratch> {
      return std::make_unique<ExactScratch>(primitives);
    },
    .solve =
        [](const Balance& balance, std::span<Vec3> forces, Scratch* scratch, const RunOptions& options) noexcept {
          return solve_exact(balance, forces, static_cast<ExactScratch&>(*scratch), options);
        }};

}  // namespace palpate::solver
