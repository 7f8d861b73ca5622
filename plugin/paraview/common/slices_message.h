#pragma once

/// Slices of a scan on their way from a server to a client: what is asked for, and what is answered. Neither names the
/// patient, a file or a folder.

#include <cstdint>
#include <string>
#include <vector>

#include "PalpateServerModule.h"
#include "io/series.h"
#include "io/volume.h"

namespace palpate::plugin {

struct SlicesAsked {
  enum class What : int { head, hashes, voxels };
  What what = What::head;
  int first = 0;
  int count = 0;
};

struct SlicesAnswered {
  std::string error;                  ///< in words for the user; empty: none
  std::string head;                   ///< of What::head: as from text_of_head()
  std::vector<std::uint64_t> hashes;  ///< one a slice, with voxels too: hash_of_slice()
  io::Volume::Voxels voxels;          ///< in scan_values() form; slices read apart may differ in type
};

/// Of the first frame of a series. Slices are taken from the process's store where it holds the scan, and read where it
/// does not: no more is held meanwhile than what is asked for. Series with several images at a position are loaded
/// whole.
SlicesAnswered answer(const io::Series& series, const SlicesAsked& asked);

/// A volume without its voxels: geometry, rescale, unit, modality, padding. Numbers come back to the last bit.
/// volume_of_head() throws std::invalid_argument for any other text.
std::string text_of_head(const io::Volume& volume);
PALPATESERVER_EXPORT io::Volume volume_of_head(const std::string& text);

}  // namespace palpate::plugin
