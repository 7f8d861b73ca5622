// A mode of one's own: a dimple that holds the proxy where the value is high.
//
// In the tree a mode is one file, modes/types/<name>_mode.cpp, and its name in modes/CMakeLists.txt. Here it is used
// without that list: it places its primitive from a sample, and the solver answers.
#include <array>
#include <cmath>
#include <cstdint>
#include <cstdio>

#include "modes/types/mode_type.h"
#include "solver/chain.h"

namespace {

namespace modes = palpate::modes;
namespace solver = palpate::solver;

const modes::ModeType dimple{
    .name = "dimple",
    .summary = "holds the proxy at a place, the harder the higher the value",
    .keys = modes::Key::strength | modes::Key::gates,
    .strength_of = modes::Datum::value,
    .reads = [](const modes::Mode&) { return palpate::io::FieldSet::none; },
    .footprint =
        [](const modes::Mode&) {
          return modes::Footprint{solver::PrimitiveType::point, modes::Axis::none, true};
        },
    .place =
        [](const modes::ActiveMode& mode, const modes::Place& place, modes::PrimitiveList& primitives) noexcept {
          primitives.add(solver::make_point(mode.strength(place.sample), place.anchor_m));
        }};

}  // namespace

int main() {
  // From 0 N at 0 HU to 1 N at 1000 HU: at 400 HU the dimple takes 0.4 N.
  const modes::TransferFunction newtons({{0, 0}, {1000, 1}});
  const modes::ActiveMode mode{.type = &dimple, .strength = modes::Strength(modes::Datum::value, newtons, {})};
  const palpate::io::Sample sample{.inside = true, .value = 400};
  const modes::Workspace workspace;
  std::array<solver::Primitive, 1> room{};
  std::array<std::uint8_t, 1> mode_of{};
  modes::PrimitiveList list(room, mode_of);
  dimple.place(mode, {.sample = sample, .workspace = workspace, .anchor_m = {0, 0, 0}}, list);

  solver::Chain chain;
  std::array<solver::Vec3, 1> forces{};
  double met = 0;
  for (const double depth : {0.0005, 0.002}) {  // m: k times the depth is 0.2 N, held, then 0.8 N, which is too much
    const solver::Balance balance{.stiffness = 400.0, .probe = {0, -depth, 0}, .primitives = room};
    const solver::Solution solution = chain.solve(balance, forces);
    met = solver::coupling_force(balance, solution.proxy).y;
    std::printf("%s: %.1f mm pulled, %.3f N felt\n", dimple.name.data(), depth * 1e3, met);
    if (depth < 0.001 && std::abs(met - 0.2) > 1e-12) return 1;
  }
  return std::abs(met - 0.4) < 1e-12 ? 0 : 1;
}
