// Writes plugin/docs/messages.md: write_message_page FILE.

#include <fstream>

#include "plugin/messages/page.h"

int main(int count, char** arguments) {
  if (count != 2) return 2;
  std::ofstream file(arguments[1]);
  file << palpate::plugin::message_page() << std::flush;
  return file ? 0 : 1;
}
