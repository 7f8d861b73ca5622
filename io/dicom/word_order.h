#pragma once

#include <cstddef>

#include "io/dicom/file_header.h"
#include "io/dicom/input_file.h"

namespace palpate::io::internal {

/// Whether the 32-bit integers of an uncompressed big-endian file were swapped as a whole, and not as two 16-bit words.
/// PS3.5 7.3 requires words, the lower one first, and DCMTK writes these; other writers swap all four bytes, and the
/// header does not tell which. So the pixels decide: in the right order, bits that are not stored are empty and
/// neighbors are similar. Reads at most 64 MiB of the frames, evenly spread. Throws DicomError if they cannot be read.
bool swapped_as_wholes(const InputFile& file, const FileHeader& header, std::size_t frames);

}  // namespace palpate::io::internal
