#pragma once

/// A cache of numbers computed from a volume's voxels (gradients, Hessians), in bricks. A worker thread computes the
/// bricks ahead of a moving point, within a memory bound.
///
/// Reading never waits. If a brick is missing or being replaced, the reader computes the cell itself with the same
/// kernel, to the same bits. A sequence number guards each brick; it is odd while the brick is written. Source: Boehm,
/// "Can seqlocks get along with programming language memory models?", MSPC 2012.

#include <atomic>
#include <condition_variable>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <span>
#include <thread>
#include <vector>

#include "io/fields/gradient.h"

namespace palpate::io::internal {

/// Computes the numbers of every voxel of a block, i fastest, those of one voxel adjacent. Called from any thread.
struct BrickContent {
  int floats_a_voxel = 0;
  std::function<void(const Block&, std::span<float>)> compute;
};

class BrickCache {
 public:
  static constexpr int cells =
      16;  ///< edge of a brick; it also holds the first voxels of the next ones, so no cell lies in two

  /// Holds bricks of a region's voxels only: as many as fit in `memory_bytes`, at least one. Starts the worker if
  /// `background`.
  BrickCache(BrickContent content, const Block& region, std::size_t memory_bytes, bool background);
  /// Waits until the worker has finished at most one brick.
  ~BrickCache();
  BrickCache(const BrickCache&) = delete;
  BrickCache& operator=(const BrickCache&) = delete;

  /// The numbers of a cell's corners (i fastest), if its brick is there. Any number of threads; in the tick.
  bool read(const Block& cell, std::span<float> corners) const noexcept;
  /// Sets the position (continuous voxel index) around which the worker fills bricks. In the tick.
  void move_to(const glm::dvec3& index) noexcept;

  /// Computes the bricks of a box of voxels (both ends included) now, on this thread. Skips bricks that are present,
  /// and those for which no brick that is farther away can be evicted.
  void fill(const glm::ivec3& low, const glm::ivec3& high);

  std::size_t capacity() const noexcept { return slots_.size(); }  ///< bricks
  std::size_t filled() const noexcept { return filled_.load(std::memory_order_relaxed); }
  std::size_t memory_bytes() const noexcept;  ///< bound on the memory of the bricks

 private:
  struct Slot {
    std::atomic<std::uint32_t> version{0};  ///< odd while being written
    std::atomic<std::int32_t> brick{-1};
  };

  std::size_t number_of(const glm::ivec3& brick) const noexcept;
  glm::dvec3 middle_of(std::size_t brick) const noexcept;
  bool is_there(std::size_t brick) const noexcept { return slot_of_[brick].load(std::memory_order_acquire) >= 0; }
  std::optional<std::size_t> slot_for(const glm::dvec3& middle, const glm::dvec3& point) const;
  bool fill_brick(const glm::ivec3& brick, const glm::dvec3& point);
  void publish(std::size_t slot, std::size_t brick, const std::vector<float>& numbers);
  glm::dvec3 point() const noexcept;

  bool fill_along(const glm::dvec3& from, const glm::dvec3& velocity);
  bool fill_around(const glm::dvec3& middle);
  void work(const std::stop_token& stop);

  BrickContent content_;
  Block region_;
  glm::ivec3 bricks_;
  std::vector<std::atomic<std::int32_t>> slot_of_;  ///< by brick; -1: not there
  std::vector<Slot> slots_;
  std::size_t brick_floats_;
  std::unique_ptr<float[]> numbers_;  ///< of all slots; accessed by atomic_ref only
  std::atomic<std::size_t> filled_{0};

  std::mutex writing_;  ///< between the worker and fill(); no reader takes it
  std::atomic<double> point_[3] = {0, 0, 0};
  std::atomic<std::uint64_t> moves_{0};

  std::mutex sleeping_;
  std::condition_variable_any wake_;
  std::jthread worker_;  // last: it uses all of the above
};

}  // namespace palpate::io::internal
