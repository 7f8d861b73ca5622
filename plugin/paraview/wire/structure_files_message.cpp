#include "plugin/paraview/wire/structure_files_message.h"

#include <array>
#include <filesystem>
#include <fstream>
#include <map>
#include <mutex>
#include <nlohmann/json.hpp>
#include <set>
#include <stdexcept>

#include "io/structures/structure.h"
#include "plugin/messages/messages.h"
#include "plugin/structures/structure_files.h"
#include "plugin/structures/study_registrations.h"

namespace palpate::plugin {
namespace {

namespace fs = std::filesystem;

std::mutex mutex;
std::map<std::string, std::vector<fs::path>> found;  // by the path that was asked for

std::set<fs::path> structure_files_in(const std::string& path) {
  const fs::path folder = fs::is_directory(path) ? fs::path(path) : fs::path(path).parent_path();
  io::StructureCatalogue catalogue = io::find_structures(std::array{folder});
  std::set<fs::path> files;
  io::Volume elsewhere;  // in a frame of its own: every registration beside a structure counts
  elsewhere.frame_of_reference_uid = "-";
  StudyRegistrations study;
  for (io::Structure& structure : catalogue.structures) {
    if (!files.insert(structure.file).second) continue;
    if (!structure.voxels_file.empty()) files.insert(structure.voxels_file);
    for (const io::Registration& one : study.beside(structure, elsewhere)) files.insert(one.file);
  }
  for (const io::Registration& one : catalogue.registrations) files.insert(one.file);
  return files;
}

}  // namespace

std::vector<ServedFile> find_served_files(const std::string& path) {
  const std::set<fs::path> files = structure_files_in(path);
  std::vector<ServedFile> served;
  served.reserve(files.size());
  for (const fs::path& file : files) {
    served.push_back({.hash = hash_of_file(file), .path = fs::absolute(file), .bytes = fs::file_size(file)});
  }
  const std::lock_guard lock(mutex);
  found[path].assign(files.begin(), files.end());
  return served;
}

std::vector<unsigned char> read_served_file(const std::string& path, int file, int first_piece, int pieces) {
  fs::path name;
  {
    const std::lock_guard lock(mutex);
    const std::vector<fs::path>& files = found[path];
    if (file < 0 || file >= static_cast<int>(files.size()) || first_piece < 0 || pieces < 1 || pieces > 64) {
      throw Refusal(say("server-has-no-such-structures"));
    }
    name = files[static_cast<std::size_t>(file)];
  }
  std::ifstream input(name, std::ios::binary);
  input.seekg(static_cast<std::streamoff>(first_piece) * static_cast<std::streamoff>(bytes_of_piece));
  std::vector<unsigned char> bytes(static_cast<std::size_t>(pieces) * bytes_of_piece);
  input.read(reinterpret_cast<char*>(bytes.data()), static_cast<std::streamsize>(bytes.size()));
  if (input.bad() || input.gcount() <= 0) throw Refusal(say("server-has-no-such-structures"));
  bytes.resize(static_cast<std::size_t>(input.gcount()));
  return bytes;
}

std::string text_of(const std::vector<ServedFile>& files) {
  nlohmann::json list = nlohmann::json::array();
  for (const ServedFile& file : files) {
    list.push_back({{"hash", file.hash}, {"path", file.path.string()}, {"bytes", file.bytes}});
  }
  return list.dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::vector<ServedFile> served_files_of(const std::string& text) {
  std::vector<ServedFile> files;
  for (const nlohmann::json& one : nlohmann::json::parse(text)) {
    const fs::path path = one.at("path").get<std::string>();
    files.push_back({.hash = one.at("hash"), .path = path, .bytes = one.at("bytes")});
    const fs::path name = path.filename();  // its name here
    if (name.empty() || name == "." || name == "..") throw Refusal(say("server-has-no-such-structures"));
  }
  return files;
}

std::vector<fs::path> places_of(const std::vector<ServedFile>& files) {
  std::map<fs::path, std::size_t> folders;
  std::vector<fs::path> places;
  for (const ServedFile& file : files) {
    const std::size_t folder = folders.emplace(file.path.parent_path(), folders.size()).first->second;
    places.push_back(fs::path(std::to_string(folder)) / file.path.filename());
  }
  return places;
}

}  // namespace palpate::plugin
