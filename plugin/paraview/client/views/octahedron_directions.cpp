#include "plugin/paraview/client/views/octahedron_directions.h"

#include <cmath>
#include <tuple>
#include <utility>

namespace palpate::plugin {
namespace {

// Even numbers of steps: the axes are met.
constexpr int across = 255, along = 255;
constexpr int no_direction = direction_codes - 1;

/// Of the lower half, which is folded outwards around the upper one; and back.
std::pair<float, float> folded(float x, float y) {
  return {std::copysign(1 - std::abs(y), x), std::copysign(1 - std::abs(x), y)};
}

}  // namespace

int code_of(const float* direction) {
  const float sum = std::abs(direction[0]) + std::abs(direction[1]) + std::abs(direction[2]);
  if (!(sum > 0)) return no_direction;
  float x = direction[0] / sum, y = direction[1] / sum;
  if (direction[2] < 0) std::tie(x, y) = folded(x, y);
  const int column = static_cast<int>(std::lround((x + 1) / 2 * (across - 1)));
  const int row = static_cast<int>(std::lround((y + 1) / 2 * (along - 1)));
  return row * across + column;
}

Direction direction_of(int code) {
  if (code >= across * along) return {0, 0, 0};
  float x = 2 * static_cast<float>(code % across) / (across - 1) - 1;
  const int row = code / across;
  float y = 2 * static_cast<float>(row) / (along - 1) - 1;
  const float z = 1 - std::abs(x) - std::abs(y);
  if (z < 0) std::tie(x, y) = folded(x, y);
  const float length = std::sqrt(x * x + y * y + z * z);
  return {x / length, y / length, z / length};
}

const std::vector<float>& decoded_directions() {
  static const std::vector<float> all = [] {
    std::vector<float> numbers;
    for (int code = 0; code < direction_codes; ++code) {
      for (const float part : direction_of(code)) numbers.push_back(part);
    }
    return numbers;
  }();
  return all;
}

}  // namespace palpate::plugin
