#include "plugin/session/scan_hash.h"

#include <fmt/format.h>
#include <xxhash.h>

#include <algorithm>
#include <cstddef>
#include <memory>
#include <variant>

namespace palpate::plugin {
namespace {

class Hash {
 public:
  Hash() { XXH3_64bits_reset(state_.get()); }
  template <typename T>
  void add(const T& value) {
    XXH3_64bits_update(state_.get(), &value, sizeof value);
  }
  template <typename T>
  void add_all(std::span<const T> values) {
    add(values.size());
    XXH3_64bits_update(state_.get(), values.data(), values.size_bytes());
  }
  std::uint64_t digest() const { return XXH3_64bits_digest(state_.get()); }

 private:
  std::unique_ptr<XXH3_state_t, XXH_errorcode (*)(XXH3_state_t*)> state_{XXH3_createState(), XXH3_freeState};
};

}  // namespace

std::uint64_t hash_of_slice(const io::Volume& volume, int k) {
  const io::Geometry& g = volume.geometry;
  const auto count = static_cast<std::size_t>(g.dimensions.x) * static_cast<std::size_t>(g.dimensions.y);
  std::vector<float> values(count);
  std::visit(
      [&](const auto& voxels) {
        const auto first = voxels.begin() + static_cast<std::ptrdiff_t>(volume.offset(0, 0, k));
        std::transform(first, first + static_cast<std::ptrdiff_t>(count), values.begin(), [&](auto stored) {
          // As Volume::value_at(); and a zero has one sign.
          return static_cast<float>(volume.slope * static_cast<double>(stored) + volume.intercept) + 0.0F;
        });
      },
      volume.voxels);
  return XXH3_64bits(values.data(), values.size() * sizeof values[0]);
}

std::vector<std::uint64_t> hashes_of_slices(const io::Volume& volume) {
  std::vector<std::uint64_t> hashes;
  const auto add = [&](const io::Volume& of) {
    for (int k = 0; k < of.geometry.dimensions.z; ++k) hashes.push_back(hash_of_slice(of, k));
  };
  add(volume);
  if (volume.vectors) {
    for (const auto& component : volume.vectors->along) add(*component);
  }
  return hashes;
}

std::string hash_of(const io::Volume& without_voxels, std::span<const std::uint64_t> slices) {
  const io::Geometry& geometry = without_voxels.geometry;
  Hash hash;
  hash.add(geometry.dimensions);
  hash.add(geometry.direction_i);
  hash.add(geometry.direction_j);
  hash.add(geometry.spacing_i);
  hash.add(geometry.spacing_j);
  hash.add_all<glm::dvec3>(geometry.slice_positions);
  hash.add_all<int>(geometry.gaps);
  const auto& padding = without_voxels.padding;
  hash.add(padding.has_value());
  if (padding) {
    const auto value = [&](double stored) { return without_voxels.slope * stored + without_voxels.intercept; };
    const auto [least, most] = std::minmax({value(padding->first), value(padding->second)});
    hash.add(least);
    hash.add(most);
  }
  if (without_voxels.vectors) hash.add(without_voxels.vectors->to_patient);
  hash.add_all(slices);
  return fmt::format("{:016x}", hash.digest());
}

std::string hash_of_series(const std::string& uid, const io::Volume& volume) {
  const std::uint64_t named = XXH3_64bits(uid.data(), uid.size());
  return hash_of(volume, {&named, 1});
}

std::string hash_of(const io::Volume& volume) {
  return hash_of(volume, hashes_of_slices(volume));
}

}  // namespace palpate::plugin
