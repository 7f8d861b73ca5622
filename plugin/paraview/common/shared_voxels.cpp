#include "plugin/paraview/common/shared_voxels.h"

#include <vtkAOSDataArrayTemplate.h>
#include <vtkFloatArray.h>
#include <vtkShortArray.h>
#include <vtkUnsignedShortArray.h>

#include <cstddef>
#include <cstdlib>
#include <functional>
#include <map>
#include <mutex>
#include <span>
#include <type_traits>
#include <utility>
#include <variant>

namespace palpate::plugin {
namespace {

/// Which volume a buffer belongs to, by the address of its first value. VTK calls back with that address alone when the
/// last array that uses the buffer goes.
class Owners {
 public:
  void add(const void* at, std::shared_ptr<const io::Volume> volume) {
    const std::lock_guard lock(mutex_);
    owners_.emplace(at, std::move(volume));
  }
  std::shared_ptr<const io::Volume> find(const void* at) {
    const std::lock_guard lock(mutex_);
    const auto found = owners_.find(at);
    return found == owners_.end() ? nullptr : found->second;
  }
  void remove(const void* at) {
    std::shared_ptr<const io::Volume> last;  // freed after the lock
    const std::lock_guard lock(mutex_);
    if (const auto found = owners_.find(at); found != owners_.end()) {
      last = std::move(found->second);
      owners_.erase(found);
    }
  }
  std::size_t size() {
    const std::lock_guard lock(mutex_);
    return owners_.size();
  }

 private:
  std::mutex mutex_;
  std::multimap<const void*, std::shared_ptr<const io::Volume>> owners_;
};

Owners& owners() {
  static auto* const all = new Owners;  // never destroyed: VTK may free arrays after our statics are gone
  return *all;
}

template <typename Stored>
auto make_array() {
  if constexpr (std::is_same_v<Stored, std::int16_t>) {
    return vtkSmartPointer<vtkShortArray>::New();
  } else if constexpr (std::is_same_v<Stored, std::uint16_t>) {
    return vtkSmartPointer<vtkUnsignedShortArray>::New();
  } else {
    return vtkSmartPointer<vtkFloatArray>::New();
  }
}

}  // namespace

vtkSmartPointer<vtkDataArray> share_voxels(const std::shared_ptr<const io::Volume>& volume, std::size_t first,
                                           std::size_t count) {
  return std::visit(
      [&](const auto& voxels) -> vtkSmartPointer<vtkDataArray> {
        using Stored = typename std::decay_t<decltype(voxels)>::value_type;
        auto array = make_array<Stored>();
        auto* const at = const_cast<Stored*>(voxels.data()) + first;
        owners().add(at, volume);
        array->SetArray(at, static_cast<vtkIdType>(count), 0, vtkAbstractArray::VTK_DATA_ARRAY_USER_DEFINED);
        array->SetArrayFreeFunction([](void* freed) { owners().remove(freed); });
        return array;
      },
      volume->voxels);
}

vtkSmartPointer<vtkDataArray> share_part(vtkDataArray& array, std::size_t first, std::size_t count) {
  const auto volume = volume_behind(array);
  if (!volume) return nullptr;
  const std::size_t bytes = static_cast<std::size_t>(array.GetNumberOfValues() * array.GetDataTypeSize());
  const auto* const at = static_cast<const std::byte*>(array.GetVoidPointer(0));
  return std::visit(
      [&](const auto& voxels) -> vtkSmartPointer<vtkDataArray> {
        const auto stored = std::as_bytes(std::span(voxels));
        // An array that was only tied to the volume lies elsewhere.
        const std::less_equal<> not_behind;
        if (!not_behind(stored.data(), at) || !not_behind(at + bytes, stored.data() + stored.size())) return nullptr;
        const auto offset = static_cast<std::size_t>(at - stored.data()) / sizeof(voxels[0]);
        auto part = share_voxels(volume, offset + first, count);
        part->SetName(array.GetName());
        return part;
      },
      volume->voxels);
}

void tie_to_volume(vtkDataArray& array, const std::shared_ptr<const io::Volume>& volume) {
  if (array.GetNumberOfValues() == 0) return;
  owners().add(array.GetVoidPointer(0), volume);
  array.SetArrayFreeFunction([](void* freed) {
    owners().remove(freed);
    std::free(freed);  // as vtkBuffer allocates
  });
}

std::shared_ptr<const io::Volume> volume_behind(vtkDataArray& array) {
  return array.GetNumberOfValues() > 0 ? owners().find(array.GetVoidPointer(0)) : nullptr;
}

std::size_t shared_array_count() {
  return owners().size();
}

}  // namespace palpate::plugin
