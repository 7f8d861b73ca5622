#include "plugin/paraview/common/scan_store.h"

#include <array>
#include <map>
#include <mutex>
#include <string>
#include <tuple>
#include <utility>
#include <variant>

#include "io/fields/filtered.h"
#include "io/load.h"
#include "io/rescaled.h"
#include "io/whole_scan.h"
#include "modes/scene/scene_json.h"
#include "plugin/paraview/common/read_part.h"
#include "plugin/paraview/common/shared_voxels.h"

namespace palpate::plugin {
namespace {

/// Something that is made once however many ask for it, and forgotten when the last of them lets go.
template <typename Key, typename Value>
class Shelf {
 public:
  template <typename Make>
  std::shared_ptr<const Value> get(const Key& key, const Make& make) {
    const std::shared_ptr<Slot> slot = slot_of(key);
    const std::lock_guard making(slot->mutex);
    if (auto held = slot->value.lock()) return held;
    std::shared_ptr<const Value> made = make();
    slot->value = made;
    return made;
  }

  std::shared_ptr<const Value> held(const Key& key) {
    const std::lock_guard lock(mutex_);
    const auto slot = slots_.find(key);
    if (slot == slots_.end() || !slot->second->mutex.try_lock()) return nullptr;
    const std::lock_guard reading(slot->second->mutex, std::adopt_lock);
    return slot->second->value.lock();
  }

  template <typename Visit>
  void visit(const Visit& visit) {
    const std::lock_guard lock(mutex_);
    for (const auto& [key, slot] : slots_) {
      if (!slot->mutex.try_lock()) continue;  // being loaded: not held yet
      const std::lock_guard reading(slot->mutex, std::adopt_lock);
      if (const auto held = slot->value.lock()) visit(*held);
    }
  }

 private:
  struct Slot {
    std::mutex mutex;
    std::weak_ptr<const Value> value;
  };

  std::shared_ptr<Slot> slot_of(const Key& key) {
    const std::lock_guard lock(mutex_);
    std::erase_if(slots_,
                  [](const auto& entry) { return entry.second.use_count() == 1 && entry.second->value.expired(); });
    auto& slot = slots_[key];
    if (!slot) slot = std::make_shared<Slot>();
    return slot;
  }

  std::mutex mutex_;
  std::map<Key, std::shared_ptr<Slot>> slots_;
};

// First file, series UID, where its first voxel and its axes are (one file and UID may hold several volumes), frame,
// extent (of a part), filter.
using ScanKey =
    std::tuple<std::filesystem::path, std::string, std::array<double, 9>, int, std::array<int, 6>, std::string>;

ScanKey key_of(const io::Series& series, int frame, const std::array<int, 6>& extent = {},
               const io::Filter& filter = {}) {
  const io::Geometry& g = series.geometry;
  const io::Vec3 first = g.slice_positions.empty() ? io::Vec3(0) : g.slice_positions.front();
  const std::array<double, 9> place{first.x,         first.y,         first.z,         g.direction_i.x, g.direction_i.y,
                                    g.direction_i.z, g.direction_j.x, g.direction_j.y, g.direction_j.z};
  return {series.files.empty() ? std::filesystem::path() : series.files.front(),
          series.uid,
          place,
          frame,
          extent,
          modes::to_json(filter)};
}

Shelf<std::filesystem::path, io::Catalogue>& catalogues() {
  static Shelf<std::filesystem::path, io::Catalogue> shelf;
  return shelf;
}

Shelf<ScanKey, io::Volume>& scans() {
  static Shelf<ScanKey, io::Volume> shelf;
  return shelf;
}

}  // namespace

std::shared_ptr<const io::Catalogue> find_scans(const std::filesystem::path& path, const io::Progress& progress) {
  const bool of_a_folder = std::filesystem::is_regular_file(path) && !io::holds_whole_scans(path);
  const auto place = of_a_folder ? std::filesystem::absolute(path).parent_path() : path;
  return catalogues().get(
      place, [&] { return std::make_shared<const io::Catalogue>(io::find_series(std::array{place}, progress)); });
}

std::shared_ptr<const io::Volume> load_scan(const io::Series& series, int frame, const io::Progress& progress) {
  return scans().get(key_of(series, frame), [&] {
    io::LoadOptions how;
    how.frame = frame;
    how.progress = progress;
    how.is_rescaled = true;
    return std::make_shared<const io::Volume>(io::load(series, how));
  });
}

std::shared_ptr<const io::Volume> load_scan(const io::Series& series, int frame, const io::Filter& filter,
                                            const io::Progress& progress) {
  if (filter.type == nullptr) return load_scan(series, frame, progress);
  return scans().get(key_of(series, frame, {}, filter),
                     [&] { return io::filtered(load_scan(series, frame, progress), filter, progress); });
}

std::shared_ptr<const io::Volume> load_part(const io::Series& series, const std::array<int, 6>& extent,
                                            const io::Progress& progress) {
  return scans().get(key_of(series, 0, extent), [&] {
    return std::make_shared<const io::Volume>(io::rescaled(read_part(series, extent, progress)));
  });
}

std::shared_ptr<const io::Volume> load_slices(const io::Series& series, int first, int count) {
  io::LoadOptions how;
  how.slices = {first, count};
  how.is_rescaled = true;
  return std::make_shared<const io::Volume>(io::load(series, how));
}

std::shared_ptr<const io::Volume> load_slice(const io::Series& series, int slice) {
  return load_slices(series, slice, 1);
}

std::shared_ptr<const io::Volume> held_scan(const io::Series& series, int frame) {
  return scans().held(key_of(series, frame));
}

StoreUse store_use() {
  StoreUse use;
  scans().visit([&](const io::Volume& volume) {
    ++use.volumes;
    use.voxel_bytes += std::visit([](const auto& v) { return v.size() * sizeof v[0]; }, volume.voxels);
  });
  use.shared_arrays = shared_array_count();
  return use;
}

}  // namespace palpate::plugin
