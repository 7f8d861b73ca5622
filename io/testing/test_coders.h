#pragma once

/// Pixels compressed for the tests of the reader, by the coders' own libraries.

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdatset.h>

#include <cstddef>
#include <filesystem>
#include <functional>
#include <vector>

namespace palpate::io::internal {

/// From here on TestImage::syntax may be JPEG or RLE.
void register_encoders();

/// The values at (i, j), in lossless JPEG 2000 or, within `near`, JPEG-LS. Throw where the library cannot.
std::vector<Uint8> jpeg2000(int columns, int rows, int bits, bool is_signed, const std::function<int(int, int)>& value);
std::vector<Uint8> jpeg_ls(int columns, int rows, int bits, int near, const std::function<int(int, int)>& value);

/// Replaces the pixels by fragments of at most `longest` bytes; the offset table stays empty.
void encapsulate(DcmDataset& dataset, E_TransferSyntax syntax, const std::vector<std::vector<Uint8>>& frames,
                 std::size_t longest);

/// Exchanges the syntax in a file written as lossless JPEG 2000 for deflated frames, which DCMTK does not know: its UID
/// has as many letters.
void call_deflated_frames(const std::filesystem::path& file);

}  // namespace palpate::io::internal
