// The order in which bricks are filled and evicted, and their number, against the distances themselves.
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <condition_variable>
#include <glm/geometric.hpp>
#include <limits>
#include <mutex>
#include <optional>
#include <random>
#include <thread>
#include <vector>

#include "io/fields/brick_cache.h"

namespace palpate::io::internal {
namespace {

constexpr int brick_cells = BrickCache::cells;

/// Remembers which bricks were computed, in their order; a test waits for them.
class Computed {
 public:
  explicit Computed(const glm::ivec3& first_voxel) : first_voxel_(first_voxel) {}

  BrickContent content() {
    return {1, [this](const Block& block, std::span<float> numbers) {
              std::ranges::fill(numbers, 1.0F);
              const std::scoped_lock lock(mutex_);
              order_.push_back((block.first - first_voxel_) / brick_cells);
              changed_.notify_all();
            }};
  }
  /// The first so many; fewer where they do not come.
  std::vector<glm::ivec3> first(std::size_t count) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, std::chrono::seconds(20), [&] { return order_.size() >= count; });
    return {order_.begin(), order_.begin() + static_cast<std::ptrdiff_t>(std::min(count, order_.size()))};
  }

 private:
  glm::ivec3 first_voxel_;
  std::mutex mutex_;
  std::condition_variable changed_;
  std::vector<glm::ivec3> order_;
};

glm::dvec3 middle_of_brick(const glm::ivec3& brick) {
  return (glm::dvec3(brick) + 0.5) * double{brick_cells};
}

// Around a point that rests: its own brick, then its neighbors, the nearest first, as far as half of the memory
// reaches.
TEST(BrickOrder, AroundAPointThatRestsTheNearestComesFirst) {
  const glm::ivec3 first_voxel(5, 2, 9);
  for (const glm::dvec3& beside : {glm::dvec3(1.7, -2.3, 0.6), glm::dvec3(-3.1, 0.4, 2.2)}) {
    const glm::ivec3 home(2, 1, 2);
    const glm::dvec3 at = middle_of_brick(home) + beside;
    std::vector<glm::ivec3> expected;
    for (int n = 0; n < 27; ++n) expected.push_back(home + glm::ivec3(n % 3 - 1, n / 3 % 3 - 1, n / 9 - 1));
    std::ranges::sort(expected, {}, [&](const glm::ivec3& brick) { return glm::distance(middle_of_brick(brick), at); });
    Computed computed(first_voxel);
    BrickCache cache(computed.content(), {first_voxel, glm::ivec3(5 * brick_cells + 1)}, std::size_t{8} << 20, true);
    EXPECT_EQ(cache.capacity(), 125U);
    cache.move_to(at + glm::dvec3(first_voxel));
    EXPECT_EQ(computed.first(27), expected);
  }
}

/// Numbers of a byte count, as the header says: a table of the bricks, and for each slot its numbers and what guards
/// them.
TEST(BrickOrder, ThereAreAsManyAsFitTheirMemory) {
  const Block region{{0, 0, 0}, {40, 50, 70}};  // 3 x 4 x 5 bricks
  for (const int floats : {1, 3, 6}) {
    const std::size_t slot = static_cast<std::size_t>(floats) * 17 * 17 * 17 * sizeof(float) + 8;
    const auto none = [](const Block&, std::span<float>) {};
    for (const std::size_t wanted : {1U, 2U, 7U, 59U, 60U}) {
      const std::size_t memory = 60 * sizeof(std::int32_t) + wanted * slot;
      const BrickCache cache({floats, none}, region, memory, false);
      EXPECT_EQ(cache.capacity(), wanted) << floats;
      EXPECT_EQ(cache.memory_bytes(), memory);
      EXPECT_EQ(BrickCache({floats, none}, region, memory - 1, false).capacity(), std::max<std::size_t>(1, wanted - 1));
      EXPECT_EQ(BrickCache({floats, none}, region, memory + slot - 1, false).capacity(), wanted);
    }
    EXPECT_EQ(BrickCache({floats, none}, region, 0, false).capacity(), 1U) << "at least one";
    EXPECT_EQ(BrickCache({floats, none}, region, 100 * slot, false).capacity(), 60U) << "not more than there are";
  }
}

/// What is asked for takes the place of what lies farthest from it; what is there is not computed again.
TEST(BrickOrder, TheFarthestGivesWay) {
  std::mt19937 random(4);
  for (int trial = 0; trial < 20; ++trial) {
    int computed = 0;
    const BrickContent content{1, [&](const Block&, std::span<float> numbers) {
                                 std::ranges::fill(numbers, 2.0F);
                                 ++computed;
                               }};
    const Block region{{0, 0, 0}, glm::ivec3(4 * brick_cells + 1)};
    const std::size_t slot = std::size_t{17} * 17 * 17 * sizeof(float) + 8;
    BrickCache cache(content, region, 64 * sizeof(std::int32_t) + 6 * slot, false);
    ASSERT_EQ(cache.capacity(), 6U);
    std::vector<glm::ivec3> held;
    int expected = 0;
    for (int n = 0; n < 60; ++n) {
      const glm::ivec3 brick(random() % 4, random() % 4, random() % 4);
      const auto away = [&](const glm::ivec3& other) {
        return glm::distance(middle_of_brick(other), middle_of_brick(brick));
      };
      if (std::ranges::find(held, brick) == held.end()) {
        const auto farthest = std::ranges::max_element(held, {}, away);
        const auto alike = std::ranges::count_if(
            held, [&](const glm::ivec3& other) { return std::abs(away(other) - away(*farthest)) < 1e-9; });
        if (held.size() == 6 && alike > 1) continue;  // either may go
        ++expected;
        if (held.size() == 6) held.erase(farthest);
        held.push_back(brick);
      }
      cache.fill(brick * brick_cells + 3, brick * brick_cells + 5);
      ASSERT_EQ(computed, expected);
      ASSERT_EQ(cache.filled(), held.size());
      for (int all = 0; all < 64; ++all) {
        const glm::ivec3 one(all % 4, all / 4 % 4, all / 16);
        std::array<float, 8> corners{};
        ASSERT_EQ(cache.read({one * brick_cells + 7, {2, 2, 2}}, corners), std::ranges::find(held, one) != held.end())
            << trial << ' ' << n;
      }
    }
    EXPECT_GT(expected, 20);
  }
}

/// Absurd points come of damaged places. Twenty rounds of them, with the worker between any two.
TEST(BrickOrder, NoPointLeadsTheWorkerOutOfTheRegion) {
  constexpr double inf = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  const std::array absurd{nan, inf, -inf, 1e308, -1e308, 3e9, -3e9, 0.0};
  const Block region{{3, 0, 5}, glm::ivec3(3 * brick_cells + 1)};
  std::atomic<int> outside = 0;
  const BrickContent content{1, [&](const Block& block, std::span<float>) {
                               const glm::ivec3 first = block.first - region.first;
                               const glm::ivec3 end = first + block.size;
                               if (std::min({first.x, first.y, first.z}) < 0 || std::max({end.x, end.y, end.z}) > 49) {
                                 ++outside;
                               }
                             }};
  for (int round = 0; round < 20; ++round) {
    BrickCache cache(content, region, std::size_t{1} << 20, true);
    for (const double x : absurd) {
      for (const double y : absurd) {
        cache.move_to({x, y, absurd.at(static_cast<std::size_t>(round) % absurd.size())});
        if (y == 0) std::this_thread::sleep_for(std::chrono::milliseconds(2));
      }
    }
  }
  EXPECT_EQ(outside, 0);
}

}  // namespace
}  // namespace palpate::io::internal
