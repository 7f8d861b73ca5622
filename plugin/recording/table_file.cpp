#include "plugin/recording/table_file.h"

#include <cerrno>

namespace palpate::plugin {

TableFile::TableFile(const std::filesystem::path& file) : file_(std::fopen(file.c_str(), "wb"), std::fclose) {
  if (!file_) throw fmt::system_error(errno, "cannot open file {}", file.string());
}

void TableFile::close() {
  if (std::fclose(file_.release()) != 0) throw fmt::system_error(errno, "cannot write to file");
}

}  // namespace palpate::plugin
