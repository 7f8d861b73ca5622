#include "plugin/report/text_file.h"

#include <fstream>
#include <stdexcept>

namespace palpate::plugin {

void write_text(const std::filesystem::path& file, std::string_view text) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream << text;
  if (!stream.flush()) {
    throw std::runtime_error(file.string() +
                             ": cannot be written; is the folder there, is it yours to write, and is there room?");
  }
}

}  // namespace palpate::plugin
