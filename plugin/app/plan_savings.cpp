#include "plugin/app/plan_savings.h"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "io/fields/volume_fields.h"
#include "modes/tick/haptic_step.h"
#include "plugin/session/prepared_scene.h"
#include "solver/chain.h"

namespace palpate::plugin {
namespace {

using io::FieldSet;
using Clock = std::chrono::steady_clock;

template <typename Work>
double us_of(const Work& work) {
  const auto begun = Clock::now();
  work();
  return std::chrono::duration<double, std::micro>(Clock::now() - begun).count();
}

double scale_of(const modes::Scene& scene, const io::Volume& volume) {
  return scene.gradient_scale_mm.value_or(io::default_gradient_scale_mm(volume.geometry));
}

io::VolumeFields fields_without_worker(const modes::Scene& scene, const std::shared_ptr<const io::Volume>& volume,
                                       FieldSet wanted, const io::SliceRange& slices) {
  io::FieldOptions options = modes::field_options(scene.sampling);
  options.background = false;  // a worker would take its time while something else is measured
  options.ahead = slices;
  return {volume, wanted, scale_of(scene, *volume), options};
}

/// The middle of the slices that a plan keeps; of the scan, where it keeps none.
glm::dvec3 middle_of(const io::Geometry& geometry, const modes::Plan& plan) {
  const int last = geometry.dimensions.z - 1;
  const int low = std::clamp(plan.slices.first, 0, last), high = std::clamp(plan.slices.last, 0, last);
  const double k = plan.slices.last < plan.slices.first ? 0.5 * last : 0.5 * (low + high);
  return geometry.to_patient({0.5 * (geometry.dimensions.x - 1), 0.5 * (geometry.dimensions.y - 1), k});
}

/// Mean time of one sample of a field, us, around a place; the best of some rounds.
double sample_us(const io::VolumeFields& fields, FieldSet field, const glm::dvec3& middle) {
  constexpr int points = 500, rounds = 5;
  fields.prepare(middle, 5);
  double best = std::numeric_limits<double>::infinity();
  for (int round = 0; round < rounds; ++round) {
    double sum = 0;  // so that nothing is optimised away
    const double us = us_of([&] {
      for (int i = 0; i < points; ++i) {
        const double along = 10.0 * i / points - 5;
        const io::Sample sample = fields.sample(middle + glm::dvec3(along, 0.3 * along, 0.1 * along), field);
        sum += sample.value + sample.gradient.x + sample.low + sample.tube.x + sample.vector.x;
      }
    });
    best = std::isfinite(sum) ? std::min(best, us / points) : best;
  }
  return best;
}

struct Cost {
  double us = 0;  ///< of a tick
  std::size_t bytes = 0;
};

/// A small movement about the middle, within half a millimeter: the same one for every plan.
Cost cost_of(const modes::Scene& scene, const modes::Plan& plan, const std::shared_ptr<const io::Volume>& volume) {
  constexpr int ticks = 400, rounds = 7;
  const io::VolumeFields source = fields_without_worker(scene, volume, scan_fields(plan), plan.slices);
  const glm::dvec3 middle = middle_of(volume->geometry, plan);
  source.prepare(middle, 5);
  solver::Chain chain({.solvers = plan.solvers});
  modes::Touch touch;
  const auto scratch = std::make_unique<modes::StepScratch>();
  double best = std::numeric_limits<double>::infinity();
  for (int round = 0; round < rounds; ++round) {
    const double us = us_of([&] {
      for (int i = 0; i < ticks; ++i) {
        const double angle = 6.2832 * i / ticks;
        const glm::dvec3 at = middle + 0.5 * glm::dvec3(std::cos(angle), std::sin(angle), std::sin(2 * angle));
        modes::step(plan, source, plan.workspace.to_device(at), touch, chain, *scratch);
      }
    });
    best = std::min(best, us / ticks);
  }
  return {best, source.memory_bytes() + chain.memory_bytes()};
}

/// The same scene with a mode that it left out, switched on and felt everywhere.
modes::Scene with_mode(modes::Scene scene, std::size_t index) {
  modes::Mode& mode = scene.modes[index];
  mode.enabled = true;
  if (mode.strength_n.maximum() <= 0) mode.strength_n = modes::TransferFunction(0.1);
  for (modes::Gate& gate : mode.gates) {
    if (gate.factor.maximum() <= 0) gate.factor = modes::TransferFunction(1);
  }
  return scene;
}

std::string size_of(std::size_t bytes) {
  const auto kib = static_cast<double>(bytes) / 1024;
  return kib < 100 ? fmt::format("{:.1f} KiB", kib) : fmt::format("{:.1f} MiB", kib / 1024);
}

std::string per_step(double us, std::size_t bytes) {
  return fmt::format("{:.2f} us a sub-step, {}", us, bytes > 0 ? size_of(bytes) + " of memory" : "no memory");
}

int floats_a_voxel(FieldSet fields) {
  const int gradient = io::contains(fields, FieldSet::low_high) ? 5 : io::contains(fields, FieldSet::gradient) ? 3 : 0;
  return gradient + (io::contains(fields, FieldSet::tube) ? 6 : 0);
}

/// The time that the plan's fields would take in the slices left out, measured on a brick in the middle.
void measure_slices(const io::SliceRange& left_out, const modes::Scene& scene, const modes::Plan& plan,
                    const std::shared_ptr<const io::Volume>& volume, Saving& saving) {
  const int floats = floats_a_voxel(plan.fields);
  saving.ms = 0;
  saving.bytes = 0;
  if (floats == 0) {
    saving.saves = "nothing: this plan computes no field ahead";
    return;
  }
  double us = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 3; ++round) {
    const io::VolumeFields source = fields_without_worker(scene, volume, scan_fields(plan), {});
    us = std::min(us, us_of([&] { source.prepare(middle_of(volume->geometry, plan), 0); }));
  }
  constexpr double voxels_a_brick = 16.0 * 16 * 16;
  const glm::ivec3 size = volume->geometry.dimensions;
  saving.ms = us * 1e-3 * (left_out.last - left_out.first + 1) * size.x * size.y / voxels_a_brick;
  const auto kept = [&](const io::SliceRange& slices) {
    return fields_without_worker(scene, volume, scan_fields(plan), slices).memory_bytes();
  };
  const bool none_kept = plan.slices.last < plan.slices.first;
  saving.bytes = kept(none_kept ? left_out
                                : io::SliceRange{std::min(plan.slices.first, left_out.first),
                                                 std::max(plan.slices.last, left_out.last)}) -
                 kept(plan.slices);
  saving.saves = fmt::format("{:.0f} ms of computing their {} ahead, {}", *saving.ms,
                             floats == 3 ? "gradients" : "gradients and what goes with them",
                             *saving.bytes > 0 ? size_of(*saving.bytes) + " of memory" : "no memory");
}

}  // namespace

std::vector<Saving> measure_savings(const modes::Scene& scene, const modes::Plan& plan,
                                    const std::shared_ptr<const io::Volume>& volume) {
  std::optional<Cost> without;
  std::vector<Saving> savings;
  for (const modes::LeftOut& entry : plan.left_out) {
    Saving saving{.what = entry.what, .why = entry.why, .saves = entry.saves};
    if (entry.field != FieldSet::none) {
      const io::VolumeFields fields = fields_without_worker(scene, volume, entry.field, plan.slices);
      saving.us = sample_us(fields, entry.field, middle_of(volume->geometry, plan));
      saving.bytes = fields.memory_bytes();
      saving.saves = per_step(*saving.us, *saving.bytes);
      if (entry.field == FieldSet::value) saving.saves += "; once a tick it is read all the same, to be shown";
    } else if (entry.slices) {
      measure_slices(*entry.slices, scene, plan, volume, saving);
    } else if (entry.mode) {
      const modes::Scene all = with_mode(scene, *entry.mode);
      modes::Plan more = modes::make_plan(all, io::fields_of(*volume), plan.workspace);
      more.slices = plan.slices;
      if (more.modes.size() > plan.modes.size()) {
        if (!without) without = cost_of(scene, plan, volume);
        const Cost with = cost_of(all, more, volume);
        saving.us = std::max(0.0, with.us - without->us);
        saving.bytes = with.bytes - std::min(with.bytes, without->bytes);
        saving.saves = per_step(*saving.us, *saving.bytes);
      }
    } else if (entry.solver != nullptr) {
      saving.us = 0;  // one that is asked before answers every tick
      saving.bytes = 0;
      if (entry.solver->make_scratch != nullptr) {
        saving.bytes = entry.solver->make_scratch(solver::ChainOptions{}.capacity)->memory_bytes();
        saving.saves = size_of(*saving.bytes) + " of scratch memory; no time: it would not be called";
      }
    }
    savings.push_back(std::move(saving));
  }
  return savings;
}

}  // namespace palpate::plugin
