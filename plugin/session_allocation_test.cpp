// The servo tick allocates nothing: operator new counts while it is armed.

#include <gtest/gtest.h>

#include <cstdlib>
#include <new>

#include "palpate/device/simulated_stylus.h"
#include "palpate/modes/scene_json.h"
#include "palpate/plugin/session.h"
#include "palpate/testdata/analytic.h"

namespace {
thread_local bool armed = false;
thread_local int allocations = 0;

void* count_and_allocate(std::size_t bytes) {
  if (armed) {
    ++allocations;
  }
  if (void* memory = std::malloc(bytes == 0 ? 1 : bytes)) {  // NOLINT: this is operator new
    return memory;
  }
  throw std::bad_alloc();
}
}  // namespace

void* operator new(std::size_t bytes) {
  return count_and_allocate(bytes);
}
void* operator new[](std::size_t bytes) {
  return count_and_allocate(bytes);
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}  // NOLINT
void operator delete[](void* memory) noexcept {
  std::free(memory);
}  // NOLINT
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}  // NOLINT
void operator delete[](void* memory, std::size_t) noexcept {
  std::free(memory);
}  // NOLINT

namespace palpate::plugin {
namespace {

TEST(SessionAllocation, TheTrapWorks) {
  armed = true;
  const int before = allocations;
  delete new int;  // NOLINT: an allocation to be counted
  armed = false;
  EXPECT_EQ(allocations, before + 1);
}

TEST(SessionAllocation, NoneInAWholePress) {
  const std::vector<testdata::Layer> layers{{.depth = 0, .value = testdata::soft_tissue_hu},
                                            {.depth = 10, .value = testdata::bone_hu}};
  auto source = std::make_shared<testdata::AnalyticSource>(testdata::make_slab({0, 0, -1}, layers), 1.5);
  auto plan = std::make_shared<const modes::Plan>(modes::make_plan(
      modes::load_scene("ct-skin-and-bone"), io::FieldSet::value | io::FieldSet::gradient, modes::Workspace{}));
  device::SimulatedStylus stylus;
  stylus.follow(std::vector<device::Waypoint>{{.time = 0, .position = {0, 0.02, 0}},
                                              {.time = 1.5, .position = {0, -0.018, 0}},
                                              {.time = 3, .position = {0.01, 0.02, 0}}});
  Session session(plan, source, stylus, limits_for(modes::Limits{}, stylus.specification()));
  bool felt = false;
  allocations = 0;
  armed = true;
  for (int n = 0; n < 3000; ++n) {
    felt = session.tick().sent_n[1] > 1.2 || felt;
  }
  armed = false;
  EXPECT_EQ(allocations, 0);
  EXPECT_TRUE(felt) << "the press has to reach the bone";
}

}  // namespace
}  // namespace palpate::plugin
