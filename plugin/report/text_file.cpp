#include "plugin/report/text_file.h"

#include <fstream>
#include <stdexcept>

#include "plugin/messages/messages.h"

namespace palpate::plugin {

void write_text(const std::filesystem::path& file, std::string_view text) {
  std::ofstream stream(file, std::ios::binary | std::ios::trunc);
  stream << text;
  if (!stream.flush()) {
    throw Refusal(say("cannot-be-written", file.string()));
  }
}

}  // namespace palpate::plugin
