#include "io/fields/brick_cache.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <glm/vector_relational.hpp>
#include <new>
#include <utility>

namespace palpate::io::internal {
namespace {

constexpr int edge = BrickCache::cells + 1;  // voxels

std::size_t slots_in(std::size_t memory_bytes, std::size_t bricks, std::size_t slot_bytes) {
  const std::size_t table = bricks * sizeof(std::int32_t);
  const std::size_t left = memory_bytes > table ? memory_bytes - table : 0;
  return std::clamp<std::size_t>(left / slot_bytes, 1, bricks);
}

glm::ivec3 bricks_of(const glm::ivec3& dimensions) {
  return (glm::max(dimensions - 1, glm::ivec3(1)) + BrickCache::cells - 1) / BrickCache::cells;
}

std::size_t floats_of_brick(int floats_a_voxel) {
  return static_cast<std::size_t>(floats_a_voxel) * edge * edge * edge;
}

std::size_t count(const glm::ivec3& n) {
  return static_cast<std::size_t>(n.x) * static_cast<std::size_t>(n.y) * static_cast<std::size_t>(n.z);
}

}  // namespace

BrickCache::BrickCache(BrickContent content, const Block& region, std::size_t memory_bytes, bool background)
    : content_(std::move(content)),
      region_(region),
      bricks_(bricks_of(region.size)),
      slot_of_(count(bricks_)),
      slots_(slots_in(memory_bytes, count(bricks_),
                      sizeof(Slot) + floats_of_brick(content_.floats_a_voxel) * sizeof(float))),
      brick_floats_(floats_of_brick(content_.floats_a_voxel)),
      numbers_(std::make_unique_for_overwrite<float[]>(slots_.size() * brick_floats_)) {
  for (auto& slot : slot_of_) {
    slot.store(-1, std::memory_order_relaxed);
  }
  if (background) {
    worker_ = std::jthread([this](const std::stop_token& stop) { work(stop); });
  }
}

BrickCache::~BrickCache() = default;

std::size_t BrickCache::memory_bytes() const noexcept {
  return slots_.size() * (brick_floats_ * sizeof(float) + sizeof(Slot)) + slot_of_.size() * sizeof(slot_of_[0]);
}

std::size_t BrickCache::number_of(const glm::ivec3& brick) const noexcept {
  return (static_cast<std::size_t>(brick.z) * static_cast<std::size_t>(bricks_.y) + static_cast<std::size_t>(brick.y)) *
             static_cast<std::size_t>(bricks_.x) +
         static_cast<std::size_t>(brick.x);
}

glm::dvec3 BrickCache::middle_of(std::size_t brick) const noexcept {
  const auto n = static_cast<int>(brick);
  const glm::ivec3 at(n % bricks_.x, n / bricks_.x % bricks_.y, n / bricks_.x / bricks_.y);
  return (glm::dvec3(at) + 0.5) * static_cast<double>(cells);
}

bool BrickCache::read(const Block& cell, std::span<float> corners) const noexcept {
  const glm::ivec3 first = cell.first - region_.first;
  if (glm::any(glm::lessThan(first, glm::ivec3(0))) || glm::any(glm::greaterThan(first + cell.size, region_.size))) {
    return false;
  }
  const glm::ivec3 brick = first / cells;
  const std::size_t number = number_of(brick);
  const std::int32_t at = slot_of_[number].load(std::memory_order_acquire);
  if (at < 0) {
    return false;
  }
  const Slot& slot = slots_[static_cast<std::size_t>(at)];
  const std::uint32_t version = slot.version.load(std::memory_order_acquire);
  if (version % 2 == 1 || slot.brick.load(std::memory_order_acquire) != static_cast<std::int32_t>(number)) {
    return false;
  }
  const glm::ivec3 from = first - brick * cells;
  float* const numbers = numbers_.get() + static_cast<std::size_t>(at) * brick_floats_;
  const int floats = content_.floats_a_voxel;
  auto corner = corners.begin();
  for (int k = 0; k < cell.size.z; ++k) {
    for (int j = 0; j < cell.size.y; ++j) {
      const int voxel = ((from.z + k) * edge + from.y + j) * edge + from.x;
      float* next = numbers + static_cast<std::ptrdiff_t>(floats) * voxel;
      for (int n = 0; n < floats * cell.size.x; ++n) {
        *corner++ = std::atomic_ref<float>(*next++).load(std::memory_order_acquire);
      }
    }
  }
  return slot.version.load(std::memory_order_relaxed) == version;  // after the loads above, since those acquire
}

void BrickCache::move_to(const glm::dvec3& index) noexcept {
  // A point beyond the region is treated as one on its edge. NaN is clamped, too, because the worker computes indices
  // from it.
  for (int axis = 0; axis < 3; ++axis) {
    const double at = index[axis] - region_.first[axis];
    point_[axis].store(std::fmin(std::fmax(at, 0.0), region_.size[axis] - 1.0), std::memory_order_relaxed);
  }
  moves_.fetch_add(1, std::memory_order_relaxed);
}

glm::dvec3 BrickCache::point() const noexcept {
  // The coordinates may come from two different moves. That is accurate enough for a prediction.
  return {point_[0].load(std::memory_order_relaxed), point_[1].load(std::memory_order_relaxed),
          point_[2].load(std::memory_order_relaxed)};
}

void BrickCache::fill(const glm::ivec3& low, const glm::ivec3& high) {
  const glm::ivec3 from = glm::max(low - region_.first, glm::ivec3(0));
  const glm::ivec3 to = glm::min(high - region_.first, region_.size - 1);
  if (glm::any(glm::greaterThan(from, to))) {
    return;
  }
  const glm::ivec3 first = glm::min(from / cells, bricks_ - 1), last = glm::min(to / cells, bricks_ - 1);
  for (int k = first.z; k <= last.z; ++k) {
    for (int j = first.y; j <= last.y; ++j) {
      for (int i = first.x; i <= last.x; ++i) {
        fill_brick({i, j, k}, middle_of(number_of({i, j, k})));
      }
    }
  }
}

/// A free slot, or that of the brick farthest from the point, if that is farther than the new one.
std::optional<std::size_t> BrickCache::slot_for(const glm::dvec3& middle, const glm::dvec3& point) const {
  std::optional<std::size_t> farthest;
  double distance = glm::distance(middle, point);
  for (std::size_t n = 0; n < slots_.size(); ++n) {
    const std::int32_t held = slots_[n].brick.load(std::memory_order_relaxed);
    if (held < 0) {
      return n;
    }
    const double d = glm::distance(middle_of(static_cast<std::size_t>(held)), point);
    if (d > distance) {
      distance = d;
      farthest = n;
    }
  }
  return farthest;
}

bool BrickCache::fill_brick(const glm::ivec3& brick, const glm::dvec3& point) {
  const std::size_t number = number_of(brick);
  const std::scoped_lock lock(writing_);
  if (is_there(number)) {
    return false;
  }
  const auto slot = slot_for(middle_of(number), point);
  if (!slot) {
    return false;
  }
  const glm::ivec3 first = brick * cells;
  const Block block{region_.first + first, glm::min(glm::ivec3(edge), region_.size - first)};
  const auto floats = static_cast<std::size_t>(content_.floats_a_voxel);
  std::vector<float> numbers(floats * block.voxels());
  content_.compute(block, numbers);
  std::vector<float> whole(brick_floats_);
  const std::size_t row = floats * static_cast<std::size_t>(block.size.x);
  auto from = numbers.begin();
  for (int k = 0; k < block.size.z; ++k) {
    for (int j = 0; j < block.size.y; ++j) {
      const std::size_t to = floats * static_cast<std::size_t>((k * edge + j) * edge);
      std::copy_n(from, row, whole.begin() + static_cast<std::ptrdiff_t>(to));
      from += static_cast<std::ptrdiff_t>(row);
    }
  }
  publish(*slot, number, whole);
  return true;
}

void BrickCache::publish(std::size_t at, std::size_t brick, const std::vector<float>& numbers) {
  Slot& slot = slots_[at];
  const std::int32_t old = slot.brick.load(std::memory_order_relaxed);
  if (old >= 0) {
    slot_of_[static_cast<std::size_t>(old)].store(-1, std::memory_order_release);
  } else {
    filled_.fetch_add(1, std::memory_order_relaxed);
  }
  const std::uint32_t version = slot.version.load(std::memory_order_relaxed);
  slot.version.store(version + 1, std::memory_order_relaxed);
  // Each of these releases, so none is seen before the odd version.
  slot.brick.store(static_cast<std::int32_t>(brick), std::memory_order_release);
  float* to = numbers_.get() + at * brick_floats_;
  for (const float number : numbers) {
    std::atomic_ref<float>(*to++).store(number, std::memory_order_release);
  }
  slot.version.store(version + 2, std::memory_order_release);
  slot_of_[brick].store(static_cast<std::int32_t>(at), std::memory_order_release);
}

/// Fills the first missing brick on the predicted path of the point, at constant velocity. False: none is missing.
bool BrickCache::fill_along(const glm::dvec3& from, const glm::dvec3& velocity) {
  constexpr double seconds_ahead = 0.2;
  constexpr int steps = 20;
  constexpr double margin = 3;          // voxels on each side of the path
  constexpr double margin_ahead = 0.3;  // of the path so far: the point may turn
  for (int n = 0; n <= steps; ++n) {
    const glm::dvec3 way = velocity * (seconds_ahead * n / steps);
    const glm::dvec3 reach(margin + margin_ahead * glm::length(way));
    const glm::dvec3 last(bricks_ - 1);
    const glm::ivec3 low(
        glm::clamp(glm::floor((from + way - reach) / static_cast<double>(cells)), glm::dvec3(0), last));
    const glm::ivec3 high(
        glm::clamp(glm::floor((from + way + reach) / static_cast<double>(cells)), glm::dvec3(0), last));
    for (int k = low.z; k <= high.z; ++k) {
      for (int j = low.y; j <= high.y; ++j) {
        for (int i = low.x; i <= high.x; ++i) {
          if (!is_there(number_of({i, j, k})) && fill_brick({i, j, k}, from)) {
            return true;
          }
        }
      }
    }
  }
  return false;
}

/// Fills the nearest missing brick, within the radius that half the memory holds. False: none is missing.
bool BrickCache::fill_around(const glm::dvec3& middle) {
  const int radius = std::max(1, static_cast<int>(0.5 * (std::cbrt(0.5 * static_cast<double>(capacity())) - 1)));
  const glm::ivec3 home(
      glm::clamp(glm::floor(middle / static_cast<double>(cells)), glm::dvec3(0), glm::dvec3(bricks_ - 1)));
  const glm::ivec3 low = glm::max(home - radius, glm::ivec3(0));
  const glm::ivec3 high = glm::min(home + radius, bricks_ - 1);
  std::optional<glm::ivec3> nearest;
  double least = 0;
  for (int k = low.z; k <= high.z; ++k) {
    for (int j = low.y; j <= high.y; ++j) {
      for (int i = low.x; i <= high.x; ++i) {
        const std::size_t number = number_of({i, j, k});
        const double distance = glm::distance(middle_of(number), middle);
        if (!is_there(number) && (!nearest || distance < least)) {
          nearest = glm::ivec3(i, j, k);
          least = distance;
        }
      }
    }
  }
  return nearest && fill_brick(*nearest, middle);
}

void BrickCache::work(const std::stop_token& stop) {
  using Clock = std::chrono::steady_clock;
  constexpr auto shortest_sleep = std::chrono::milliseconds(1);
  constexpr auto longest_sleep = std::chrono::milliseconds(20);
  constexpr double smoothing_s = 0.01;
  auto sleep = shortest_sleep;
  std::uint64_t seen = 0;
  glm::dvec3 last(0);
  glm::dvec3 velocity(0);  // voxels per second; by the clock, which may decide what is ready but never what is felt
  auto last_time = Clock::now();
  try {
    while (!stop.stop_requested()) {
      const std::uint64_t moves = moves_.load(std::memory_order_relaxed);
      const glm::dvec3 here = point();
      const auto now = Clock::now();
      const double dt = std::chrono::duration<double>(now - last_time).count();
      bool busy = false;
      if (moves != 0) {
        if (seen != 0 && dt > 0) {
          velocity += std::min(dt / smoothing_s, 1.0) * ((here - last) / dt - velocity);
        }
        busy = fill_along(here, velocity) || fill_around(here);
      }
      sleep = busy || moves != seen ? shortest_sleep : std::min(2 * sleep, longest_sleep);
      seen = moves;
      last = here;
      last_time = now;
      if (!busy) {
        std::unique_lock lock(sleeping_);
        wake_.wait_for(lock, stop, sleep, [] { return false; });
      }
    }
  } catch (const std::bad_alloc&) {
    // Out of memory: existing bricks stay, the rest is computed at the sample.
  }
}

}  // namespace palpate::io::internal
