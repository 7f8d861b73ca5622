#pragma once

/// The files of a study's structures, sent from a server to a client: segmentations, contours, label maps and the
/// registrations between them and the scan. Whole files are sent, with their names, because a scene uses the server's
/// names.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "PalpateServerModule.h"

namespace palpate::plugin {

/// One such file.
struct ServedFile {
  std::string hash;            ///< as of hash_of_file()
  std::filesystem::path path;  ///< absolute, on the server
  std::uint64_t bytes = 0;
};

inline constexpr std::size_t bytes_of_piece = 1U << 20U;

/// The files in a scan's folder, or in the folder of its file, with all subfolders. Blocks while headers are read. A
/// header with voxels in a file beside it brings that file, too.
std::vector<ServedFile> find_served_files(const std::string& path);

/// Pieces of one of these files, fewer at its end. Throws std::runtime_error if it was not found before or cannot be
/// read.
std::vector<unsigned char> read_served_file(const std::string& path, int file, int first_piece, int pieces);

std::string text_of(const std::vector<ServedFile>& files);
/// Throws std::exception for any other text.
PALPATESERVER_EXPORT std::vector<ServedFile> served_files_of(const std::string& text);

/// Relative paths for the files in a folder of the client, in the same order. Files of one folder stay in one folder
/// under their own names, so that a header finds its voxels.
PALPATESERVER_EXPORT std::vector<std::filesystem::path> places_of(const std::vector<ServedFile>& files);

}  // namespace palpate::plugin
