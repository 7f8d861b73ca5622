#include "device/testing/test_files.h"

#include <cerrno>
#include <cstdlib>
#include <fstream>
#include <system_error>

namespace palpate::device {

namespace fs = std::filesystem;

TestFiles::TestFiles() {
  std::string pattern = fs::temp_directory_path() / "palpate-device-XXXXXX";
  if (mkdtemp(pattern.data()) == nullptr) throw std::system_error(errno, std::generic_category(), pattern);
  folder_ = pattern;
  // mkdtemp keeps it to this user; a client may be another.
  fs::permissions(folder_,
                  fs::perms::group_read | fs::perms::group_exec | fs::perms::others_read | fs::perms::others_exec,
                  fs::perm_options::add);
}

TestFiles::~TestFiles() {
  std::error_code ignored;
  fs::remove_all(folder_, ignored);
}

std::string TestFiles::write(const std::string& name, const std::string& bytes) const {
  std::string path = folder_ / name;
  std::ofstream file(path, std::ios::binary);
  file.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  file.close();
  if (!file) throw std::system_error(errno, std::generic_category(), path);
  return path;
}

}  // namespace palpate::device
