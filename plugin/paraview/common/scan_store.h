#pragma once

/// The process's scans: all who want the voxels of a series (the reader, a filter, the panel) gets the same ones,
/// loaded once. The store itself keeps nothing alive: a scan goes when its last user lets go.

#include <array>
#include <cstddef>
#include <filesystem>
#include <memory>

#include "PalpateServerModule.h"
#include "io/filter.h"
#include "io/progress.h"
#include "io/series.h"
#include "io/volume.h"

namespace palpate::plugin {

/// The series in a folder; of a file's folder where `path` is a file, for one slice is no scan. Throws as
/// io::find_series(). From any thread.
PALPATESERVER_EXPORT std::shared_ptr<const io::Catalogue> find_scans(const std::filesystem::path& path,
                                                                     const io::Progress& progress = {});

/// The voxels of one frame of a series, in scan_values() form. A second caller waits for the first; if the first
/// cancels, the second loads. Throws as io::load(). From any thread.
PALPATESERVER_EXPORT std::shared_ptr<const io::Volume> load_scan(const io::Series& series, int frame,
                                                                 const io::Progress& progress = {});
/// The same through a filter.
PALPATESERVER_EXPORT std::shared_ptr<const io::Volume> load_scan(const io::Series& series, int frame,
                                                                 const io::Filter& filter,
                                                                 const io::Progress& progress = {});

/// A part of the first frame: inclusive i, j, k ranges. What a rank of a parallel server holds of a scan that may not
/// fit one machine; needs little more memory than the part. Fewer slices where some cannot be decoded.
std::shared_ptr<const io::Volume> load_part(const io::Series& series, const std::array<int, 6>& extent,
                                            const io::Progress& progress = {});

/// Some slices of the first frame, not kept in the store. Fewer where some cannot be decoded.
std::shared_ptr<const io::Volume> load_slices(const io::Series& series, int first, int count);
std::shared_ptr<const io::Volume> load_slice(const io::Series& series, int slice);

/// The whole frame where somebody holds it; none otherwise, also while it is being loaded.
std::shared_ptr<const io::Volume> held_scan(const io::Series& series, int frame);

/// What is held in this process at the moment.
struct StoreUse {
  std::size_t volumes = 0;
  std::size_t voxel_bytes = 0;
  std::size_t shared_arrays = 0;  ///< VTK arrays that view those voxels
};
PALPATESERVER_EXPORT StoreUse store_use();

}  // namespace palpate::plugin
