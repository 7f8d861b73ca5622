#pragma once

/// Compresses pixels for the tests of the reader, with the codecs' own libraries.

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdatset.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

namespace palpate::io::internal {

/// After this call TestImage::syntax may be JPEG or RLE.
void register_encoders();

/// The values at (i, j), in lossless JPEG 2000, or in JPEG-LS with errors up to `near`. They throw if the library
/// cannot.
std::vector<Uint8> jpeg2000(int columns, int rows, int bits, bool is_signed, const std::function<int(int, int)>& value);
std::vector<Uint8> jpeg_ls(int columns, int rows, int bits, int near, const std::function<int(int, int)>& value);

/// Replaces the pixels by fragments of at most `longest` bytes; the offset table stays empty.
void encapsulate(DcmDataset& dataset, E_TransferSyntax syntax, const std::vector<std::vector<Uint8>>& frames,
                 std::size_t longest);

/// Changes the syntax of a file that was written as lossless JPEG 2000 to deflated frames, which DCMTK does not know.
/// Both UIDs have the same length.
void call_deflated_frames(const std::filesystem::path& file);

}  // namespace palpate::io::internal
