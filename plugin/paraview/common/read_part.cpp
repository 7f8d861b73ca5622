#include "plugin/paraview/common/read_part.h"

#include <algorithm>
#include <glm/geometric.hpp>
#include <utility>
#include <variant>

#include "io/load.h"

namespace palpate::plugin {
namespace {

/// Cuts rows and columns away.
io::Volume cut(const io::Volume& volume, const std::array<int, 6>& extent) {
  io::Volume part = volume;  // of a few slices
  part.geometry.dimensions.x = extent[1] - extent[0] + 1;
  part.geometry.dimensions.y = extent[3] - extent[2] + 1;
  const io::Geometry& g = volume.geometry;
  for (auto& position : part.geometry.slice_positions) {
    position += extent[0] * g.spacing_i * g.direction_i + extent[2] * g.spacing_j * g.direction_j;
  }
  std::visit(
      [&](auto& voxels) {
        auto out = voxels.begin();  // never behind what is still to be read
        for (int k = 0; k < g.dimensions.z; ++k) {
          for (int j = extent[2]; j <= extent[3]; ++j) {
            const auto row = voxels.begin() + static_cast<std::ptrdiff_t>(volume.offset(extent[0], j, k));
            out = std::copy(row, row + part.geometry.dimensions.x, out);
          }
        }
        voxels.erase(out, voxels.end());
      },
      part.voxels);
  return part;
}

/// Puts further slices on top.
void append(io::Volume& volume, const io::Volume& more) {
  io::Geometry& g = volume.geometry;
  const double pitch = glm::distance(g.slice_positions.back(), more.geometry.slice_positions.front());
  constexpr double gap = 1.5;  // slices that could not be decoded lay between
  if (pitch > gap * glm::length(g.step)) g.gaps.push_back(g.dimensions.z - 1);
  for (const int behind : more.geometry.gaps) g.gaps.push_back(g.dimensions.z + behind);
  g.dimensions.z += more.geometry.dimensions.z;
  g.slice_positions.insert(g.slice_positions.end(), more.geometry.slice_positions.begin(),
                           more.geometry.slice_positions.end());
  std::visit(
      [&](auto& voxels) {
        const auto& added = std::get<std::decay_t<decltype(voxels)>>(more.voxels);
        voxels.insert(voxels.end(), added.begin(), added.end());
      },
      volume.voxels);
  volume.warnings.insert(volume.warnings.end(), more.warnings.begin(), more.warnings.end());
}

}  // namespace

io::Volume read_part(const io::Series& series, const std::array<int, 6>& extent, const io::Progress& progress) {
  const glm::ivec3& size = series.geometry.dimensions;
  const int slices = extent[5] - extent[4] + 1;
  io::LoadOptions how;
  if (extent[0] == 0 && extent[1] == size.x - 1 && extent[2] == 0 && extent[3] == size.y - 1) {
    how.slices = {extent[4], slices};
    how.progress = progress;
    return io::load(series, how);
  }
  constexpr int at_a_time = 32;
  io::Volume part;
  for (int done = 0; done < slices; done += at_a_time) {
    how.slices = {extent[4] + done, std::min(at_a_time, slices - done)};
    how.progress = [&](double share) { return !progress || progress((done + share * how.slices->count) / slices); };
    io::Volume more = cut(io::load(series, how), extent);
    if (done > 0) {
      append(part, more);
      continue;
    }
    part = std::move(more);
    const auto voxels = static_cast<std::size_t>(part.geometry.dimensions.x) *
                        static_cast<std::size_t>(part.geometry.dimensions.y) * static_cast<std::size_t>(slices);
    std::visit([&](auto& stored) { stored.reserve(voxels); }, part.voxels);
  }
  return part;
}

}  // namespace palpate::plugin
