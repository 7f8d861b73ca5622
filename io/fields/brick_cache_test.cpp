#include "io/fields/brick_cache.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <bit>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <mutex>
#include <thread>
#include <vector>

#include "io/fields/volume_fields.h"
#include "testdata/scan.h"

namespace palpate::io {
namespace {

constexpr FieldSet both = FieldSet::value | FieldSet::gradient;
constexpr FieldOptions no_bricks{.brick_bytes = 0, .background = false};
constexpr FieldOptions on_request{.background = false};

std::shared_ptr<const Volume> head_like() {
  testdata::Grid grid;
  grid.size = {70, 66, 40};
  grid.spacing = {1, 1, 1.5};
  return std::make_shared<const Volume>(
      testdata::scan(testdata::make_shell(20, 28), testdata::make_geometry(grid), {.noise = 20, .circle_radius = 31}));
}

/// A smooth walk that stays mostly inside and crosses brick borders, the volume's edge and the padding.
Vec3 step_of_walk(int n) {
  const double t = n * 0.01;
  return {36 * std::sin(1.3 * t), 34 * std::sin(1.7 * t + 1), 31 * std::sin(0.9 * t + 2)};
}

bool same_bits(const Vec3& a, const Vec3& b) {
  const auto bits = [](double d) { return std::bit_cast<std::uint64_t>(d); };
  return bits(a.x) == bits(b.x) && bits(a.y) == bits(b.y) && bits(a.z) == bits(b.z);
}

bool same_bits(const Sample& a, const Sample& b) {
  return a.inside == b.inside && same_bits({a.value, a.low, a.high}, {b.value, b.low, b.high}) &&
         same_bits(a.gradient, b.gradient) && same_bits(a.tube, b.tube);
}

TEST(Bricks, GiveTheBitsOfTheKernelAtTheSample) {
  const auto volume = head_like();
  const VolumeFields plain(volume, both, 2, no_bricks);
  const VolumeFields bricks(volume, both, 2, on_request);
  bricks.prepare({0, 0, 0}, 100);
  int inside = 0;
  for (int n = 0; n < 5000; ++n) {
    const Vec3 p = step_of_walk(n);
    const Sample a = plain.sample(p, both);
    const Sample b = bricks.sample(p, both);
    ASSERT_TRUE(same_bits(a, b));
    ASSERT_FALSE(a.from_brick);
    ASSERT_EQ(b.from_brick, b.inside);
    inside += a.inside;
  }
  EXPECT_GT(inside, 1000);
}

TEST(Bricks, OfTubesAndOfCentralDifferencesGiveTheBitsOfTheSampleToo) {
  constexpr FieldSet all = both | FieldSet::tube | FieldSet::low_high;
  const auto volume = head_like();
  for (const GradientMethod method : {GradientMethod::gaussian, GradientMethod::central_differences}) {
    const VolumeFields plain(volume, all, 1.2, {.gradient = method, .brick_bytes = 0, .background = false});
    const VolumeFields bricks(volume, all, 1.2, {.gradient = method, .background = false});
    bricks.prepare({0, 0, 0}, 100);
    int tubes = 0;
    for (int n = 0; n < 1500; ++n) {
      const Vec3 p = step_of_walk(3 * n);
      const Sample a = plain.sample(p, all);
      const Sample b = bricks.sample(p, all);
      ASSERT_TRUE(same_bits(a, b)) << n;
      ASSERT_EQ(b.from_brick, b.inside);
      tubes += a.tube != Vec3(0);
    }
    EXPECT_GT(tubes, 100);
  }
}

TEST(Bricks, AreOnlyWhereTheyWerePrepared) {
  const VolumeFields fields(head_like(), both, 2, on_request);
  EXPECT_FALSE(fields.sample({20, 0, 0}, both).from_brick);
  fields.prepare({20, 0, 0}, 1);
  EXPECT_TRUE(fields.sample({20, 0, 0}, both).from_brick);
  EXPECT_FALSE(fields.sample({-20, 0, 0}, both).from_brick);
  EXPECT_FALSE(fields.sample({20, 0, 0}, FieldSet::value).from_brick);
}

/// Of a region, bricks are computed of its voxels and of no others, wherever the point goes and whichever thread asks.
TEST(Bricks, AreComputedOfTheirRegionAlone) {
  std::mutex counting;
  std::vector<int> times(70);  // each slice was computed, of how many bricks
  int outside = 0;
  const Block region{{3, 0, 18}, {40, 50, 35}};
  const internal::BrickContent content{1, [&](const Block& block, std::span<float> numbers) {
                                         const std::scoped_lock lock(counting);
                                         const glm::ivec3 first = block.first - region.first;
                                         const glm::ivec3 end = first + block.size;
                                         for (int axis = 0; axis < 3; ++axis) {
                                           outside += first[axis] < 0 || end[axis] > region.size[axis];
                                         }
                                         for (int k = 0; k < block.size.z; ++k) {
                                           ++times[static_cast<std::size_t>(block.first.z + k)];
                                         }
                                         std::size_t n = 0;
                                         for (int k = 0; k < block.size.z; ++k) {
                                           for (int j = 0; j < block.size.y; ++j) {
                                             for (int i = 0; i < block.size.x; ++i) {
                                               const glm::ivec3 at = block.first + glm::ivec3(i, j, k);
                                               numbers[n++] = static_cast<float>(at.x + 100 * at.y + 10000 * at.z);
                                             }
                                           }
                                         }
                                       }};
  {
    internal::BrickCache by_worker(content, region, std::size_t{10} << 20, true);
    for (int n = 0; n < 200; ++n) {
      by_worker.move_to({20 + 30 * std::sin(0.3 * n), 30, 35 + 34 * std::sin(0.1 * n)});
      std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  }
  internal::BrickCache cache(content, region, std::size_t{10} << 20, false);
  cache.fill(glm::ivec3(0), glm::ivec3(69));
  EXPECT_EQ(cache.filled(), cache.capacity());
  EXPECT_EQ(outside, 0);
  for (int slice = 0; slice < 70; ++slice) {
    EXPECT_EQ(times[static_cast<std::size_t>(slice)] > 0, slice >= 18 && slice < 53) << slice;
  }
  int read = 0;
  for (int k = 0; k < 69; ++k) {
    for (int j = 0; j < 69; ++j) {
      for (int i = 0; i < 69; ++i) {
        std::array<float, 8> corners{};
        const bool inside = i >= 3 && i < 42 && j < 49 && k >= 18 && k < 52;
        ASSERT_EQ(cache.read({{i, j, k}, {2, 2, 2}}, corners), inside) << i << " " << j << " " << k;
        ASSERT_TRUE(!inside || corners[7] == static_cast<float>(i + 1 + 100 * (j + 1) + 10000 * (k + 1)));
        read += inside;
      }
    }
  }
  EXPECT_EQ(read, 39 * 49 * 34);
}

TEST(Bricks, OfSomeSlicesGiveTheSameBitsAndTakeLessMemory) {
  constexpr FieldSet all = both | FieldSet::tube | FieldSet::low_high;
  const auto volume = head_like();
  const SliceRange slices{8, 23};
  const VolumeFields plain(volume, all, 2, no_bricks);
  const VolumeFields some(volume, all, 2, {.background = false, .ahead = slices});
  EXPECT_LT(2 * some.memory_bytes(), VolumeFields(volume, all, 2, on_request).memory_bytes());
  EXPECT_EQ(VolumeFields(volume, all, 2, {.ahead = {40, 50}}).memory_bytes(), 0U) << "there is none of them";
  some.prepare({0, 0, 0}, 100);
  int there = 0, elsewhere = 0;
  for (int n = 0; n < 3000; ++n) {
    const Vec3 p = step_of_walk(3 * n);
    const Sample a = plain.sample(p, all);
    const Sample b = some.sample(p, all);
    ASSERT_TRUE(same_bits(a, b)) << n;
    const double k = volume->geometry.to_index(p).z;
    ASSERT_EQ(b.from_brick, b.inside && k >= slices.first && k < slices.last) << k;
    there += b.from_brick;
    elsewhere += b.inside && !b.from_brick;
  }
  EXPECT_GT(there, 100);
  EXPECT_GT(elsewhere, 100);
}

TEST(Bricks, StayUnderTheirBoundAndKeepTheLatest) {
  const auto volume = head_like();
  const FieldOptions little{.brick_bytes = std::size_t{300} << 10, .background = false};
  const VolumeFields fields(volume, both, 2, little);
  EXPECT_LE(fields.memory_bytes(), little.brick_bytes);
  EXPECT_GT(fields.memory_bytes(), little.brick_bytes / 2);
  const VolumeFields plain(volume, both, 2, no_bricks);
  for (int n = 0; n < 2000; n += 40) {
    const Vec3 p = step_of_walk(n);
    fields.prepare(p, 0);
    const Sample s = fields.sample(p, both);
    EXPECT_EQ(s.from_brick, s.inside);
    EXPECT_TRUE(same_bits(s, plain.sample(p, both)));
  }
}

TEST(Bricks, WorkerBringsThemToWhereThePointIs) {
  const VolumeFields fields(head_like(), both, 2);
  bool there = false;
  for (int n = 0; n < 10000 && !there; ++n) {  // many times what one brick takes
    there = fields.sample({20, 3, 2}, both).from_brick;
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
  EXPECT_TRUE(there);
}

TEST(Bricks, TwoReadersAndAWorkerThatEvictsNeverSeeOtherBits) {
  const auto volume = head_like();
  const VolumeFields plain(volume, both, 1.5, no_bricks);
  const VolumeFields fields(volume, both, 1.5, {.brick_bytes = std::size_t{600} << 10, .background = true});
  std::atomic<int> wrong{0};
  std::atomic<int> from_brick{0};
  const auto walk = [&](int first) {
    for (int n = 0; n < 3000; ++n) {
      const Vec3 p = step_of_walk(first + n / 3);
      const Sample s = fields.sample(p, both);
      wrong += !same_bits(s, plain.sample(p, both));
      from_brick += s.from_brick;
      if (n % 10 == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
  };
  std::thread other(walk, 4000);
  walk(0);
  other.join();
  EXPECT_EQ(wrong, 0);
  RecordProperty("from_brick", from_brick.load());
}

}  // namespace
}  // namespace palpate::io
