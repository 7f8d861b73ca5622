#pragma once

/// The files of a study's structures on their way from a server to a client: segmentations, contours, label maps and
/// the registrations that join them to the scan. They go over whole, with their names: a scene names them as the server
/// does.

#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "PalpateServerModule.h"

namespace palpate::plugin {

/// One of them.
struct ServedFile {
  std::string hash;            ///< as of hash_of_file()
  std::filesystem::path path;  ///< absolute, on the server
  std::uint64_t bytes = 0;
};

inline constexpr std::size_t bytes_of_piece = 1U << 20U;

/// Those of the folder that a scan was opened from, or of its file's folder, searched to the bottom. Blocks while
/// headers are read. A header whose voxels are in a file beside it brings that file.
std::vector<ServedFile> find_served_files(const std::string& path);

/// Pieces of one of them, fewer where it ends. Throws std::runtime_error if it was not found before or cannot be read.
std::vector<unsigned char> read_served_file(const std::string& path, int file, int first_piece, int pieces);

std::string text_of(const std::vector<ServedFile>& files);
/// Throws std::exception for any other text.
PALPATESERVER_EXPORT std::vector<ServedFile> served_files_of(const std::string& text);

/// Where each is put in a folder of the client: files of one folder in one folder, by their own names, so that a header
/// finds its voxels. Relative paths, in their order.
PALPATESERVER_EXPORT std::vector<std::filesystem::path> places_of(const std::vector<ServedFile>& files);

}  // namespace palpate::plugin
