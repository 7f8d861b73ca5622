#include "testdata/invesalius.h"

#include <archive.h>
#include <archive_entry.h>

#include <algorithm>
#include <cstring>
#include <memory>
#include <pugixml.hpp>
#include <stdexcept>
#include <string>
#include <string_view>

#include "testdata/scan.h"

namespace palpate::testdata {
namespace {

namespace fs = std::filesystem;

[[noreturn]] void refuse(const fs::path& file, const std::string& why) {
  throw std::runtime_error(file.string() + ": " + why);
}

/// A named file of the archive, in whatever folder it lies.
std::string read_entry(const fs::path& file, const std::string& name) {
  constexpr std::size_t block = 65536;
  const std::unique_ptr<archive, int (*)(archive*)> reader(archive_read_new(), archive_read_free);
  archive_read_support_filter_gzip(reader.get());
  archive_read_support_format_tar(reader.get());
  if (archive_read_open_filename(reader.get(), file.c_str(), block) != ARCHIVE_OK) {
    refuse(file, std::string("cannot be opened as a gzipped tar (") + archive_error_string(reader.get()) + ")");
  }
  for (archive_entry* entry = nullptr; archive_read_next_header(reader.get(), &entry) == ARCHIVE_OK;) {
    const char* path = archive_entry_pathname(entry);
    if (path == nullptr || fs::path(path).filename() != name) {
      continue;
    }
    constexpr la_int64_t largest = la_int64_t{4} << 30;
    const la_int64_t size = archive_entry_size(entry);
    if (size < 0 || size > largest) {
      refuse(file, name + " is larger than 4 GiB");
    }
    std::string content(static_cast<std::size_t>(size), '\0');
    if (archive_read_data(reader.get(), content.data(), content.size()) != static_cast<la_ssize_t>(size)) {
      refuse(file, name + " is truncated");
    }
    return content;
  }
  refuse(file, "holds no " + name);
}

/// The value that follows a key of a property list's dictionary.
pugi::xml_node value_of(const pugi::xml_node& dictionary, std::string_view key) {
  for (const pugi::xml_node& node : dictionary.children("key")) {
    if (node.text().get() == key) {
      return node.next_sibling();
    }
  }
  return {};
}

struct Project {
  Grid grid;
  std::string matrix;  ///< name of the file of voxels
};

Project read_project(const fs::path& file) {
  const std::string text = read_entry(file, "main.plist");
  pugi::xml_document document;
  if (!document.load_buffer(text.data(), text.size())) {
    refuse(file, "main.plist is not XML");
  }
  const pugi::xml_node top = document.child("plist").child("dict");
  const pugi::xml_node matrix = value_of(top, "matrix");
  constexpr int axial = 1;
  if (value_of(top, "orientation").text().as_int() != axial) {
    refuse(file, "is not an axial scan");
  }
  if (value_of(top, "modality").text().get() != std::string_view("CT")) {
    refuse(file, "is not a CT");
  }
  if (value_of(matrix, "dtype").text().get() != std::string_view("int16")) {
    refuse(file, "its voxels are not int16");
  }
  Project project;
  project.matrix = fs::path(value_of(matrix, "filename").text().get()).filename().string();
  int axis = 2;  // the shape is slices, rows, columns; the spacing columns, rows, slices
  for (const pugi::xml_node& size : value_of(matrix, "shape").children("integer")) {
    if (axis >= 0) {
      project.grid.size[axis--] = size.text().as_int();
    }
  }
  int known = 0;
  for (const pugi::xml_node& mm : value_of(top, "spacing").children("real")) {
    if (known < 3) {
      project.grid.spacing[known++] = mm.text().as_double();
    }
  }
  if (axis != -1 || known != 3) {
    refuse(file, "main.plist lacks the matrix's shape or the spacing");
  }
  return project;
}

}  // namespace

io::Volume read_invesalius(const fs::path& file) {
  if (!fs::is_regular_file(file)) {
    refuse(file, "no such file (Debian: apt-get install invesalius-examples)");
  }
  const Project project = read_project(file);
  io::Volume volume;
  try {
    volume.geometry = make_geometry(project.grid);
  } catch (const std::invalid_argument& error) {
    refuse(file, error.what());
  }
  const glm::ivec3 size = project.grid.size;
  const std::string bytes = read_entry(file, project.matrix);
  std::vector<std::int16_t> voxels(volume.offset(0, 0, size.z));
  if (bytes.size() != voxels.size() * sizeof(voxels[0])) {
    refuse(file, project.matrix + " does not hold as many voxels as main.plist says");
  }
  const std::size_t row_bytes = static_cast<std::size_t>(size.x) * sizeof(voxels[0]);
  for (int k = 0; k < size.z; ++k) {
    for (int j = 0; j < size.y; ++j) {
      std::memcpy(voxels.data() + volume.offset(0, j, k),
                  bytes.data() + volume.offset(0, size.y - 1 - j, k) * sizeof(voxels[0]), row_bytes);
    }
  }
  volume.voxels = std::move(voxels);
  volume.unit = "HU";
  volume.modality = "CT";
  return volume;
}

}  // namespace palpate::testdata
