#pragma once

/// The process's scans. Everything that needs the voxels of a series (the reader, a filter, the panel) gets the same
/// ones, loaded once. The store itself keeps nothing alive: a scan is freed when its last user releases it.

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

/// The series in a folder, or in a file that holds whole scans. For any other file: the series in its folder, because
/// one slice is not a scan. Throws as io::find_series(). From any thread.
PALPATESERVER_EXPORT std::shared_ptr<const io::Catalogue> find_scans(const std::filesystem::path& path,
                                                                     const io::Progress& progress = {});

/// The voxels of one frame of a series, rescaled (io/rescaled.h). A second caller waits for the first; if the first
/// cancels, the second loads. Throws as io::load(). From any thread.
PALPATESERVER_EXPORT std::shared_ptr<const io::Volume> load_scan(const io::Series& series, int frame,
                                                                 const io::Progress& progress = {});
/// The same through a filter.
PALPATESERVER_EXPORT std::shared_ptr<const io::Volume> load_scan(const io::Series& series, int frame,
                                                                 const io::Filter& filter,
                                                                 const io::Progress& progress = {});

/// A part of the first frame: inclusive i, j, k ranges. A rank of a parallel server holds such a part of a scan that
/// may not fit one machine. Needs little more memory than the part. Has fewer slices if some cannot be decoded.
std::shared_ptr<const io::Volume> load_part(const io::Series& series, const std::array<int, 6>& extent,
                                            const io::Progress& progress = {});

/// Some slices of the first frame, not kept in the store. Fewer if some cannot be decoded.
std::shared_ptr<const io::Volume> load_slices(const io::Series& series, int first, int count);
std::shared_ptr<const io::Volume> load_slice(const io::Series& series, int slice);

/// The whole frame if it is in use; none otherwise, and none while it is being loaded.
std::shared_ptr<const io::Volume> held_scan(const io::Series& series, int frame);

/// The present contents of this process's store.
struct StoreUse {
  std::size_t volumes = 0;
  std::size_t voxel_bytes = 0;
  std::size_t shared_arrays = 0;  ///< VTK arrays that view those voxels
};
PALPATESERVER_EXPORT StoreUse store_use();

}  // namespace palpate::plugin
