#pragma once

/// The request of a client for slices of a scan, and the answer of the server. Neither names the patient, a file or a
/// folder. Of the patient's name and id only hashes are sent, to be compared with those of a structure.

#include <cstdint>
#include <string>
#include <vector>

#include "PalpateServerModule.h"
#include "io/series.h"
#include "io/volume.h"

namespace palpate::plugin {

struct SlicesAsked {
  enum class What : int { head, hashes, voxels, structures, structure_pieces };
  What what = What::head;
  int frame = 0;  ///< of a series with several images at a position, from 0; for pieces of structures: the file
  int first = 0;  ///< slice, or piece (structure_files_message.h)
  int count = 0;
};

struct SlicesAnswered {
  std::string error;                  ///< in words for the user; empty: none
  std::string head;                   ///< for What::head: text_of_head()
  std::vector<std::uint64_t> hashes;  ///< hash_of_slice() of each slice, also with What::voxels
  std::string structures;             ///< for What::structures: text_of()
  std::vector<unsigned char> bytes;   ///< for What::structure_pieces
  io::Volume::Voxels voxels;          ///< rescaled; slices read apart may differ in type
};

/// Takes the slices from the process's store if it holds the scan; otherwise reads only the requested slices. Series
/// with several images at a position are loaded whole.
SlicesAnswered answer(const io::Series& series, const SlicesAsked& asked);

/// A volume without its voxels: geometry, rescale, unit, modality, part of the body, padding, frame of reference, and
/// hashes of the patient's name and id (study_structures.h). Numbers come back to the last bit. volume_of_head() throws
/// std::invalid_argument for any other text.
std::string text_of_head(const io::Volume& volume);
PALPATESERVER_EXPORT io::Volume volume_of_head(const std::string& text);

}  // namespace palpate::plugin
