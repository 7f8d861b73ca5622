#pragma once

/// Counts how often files are opened, by any process, with inotify.

#include <sys/inotify.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace palpate::plugin::testing {

class OpenedFiles {
 public:
  /// Watches the files of these folders, without subfolders.
  explicit OpenedFiles(const std::vector<std::filesystem::path>& folders) : events_(::inotify_init1(IN_NONBLOCK)) {
    for (const std::filesystem::path& folder : folders) ::inotify_add_watch(events_, folder.c_str(), IN_OPEN);
  }
  OpenedFiles(const OpenedFiles&) = delete;
  OpenedFiles& operator=(const OpenedFiles&) = delete;
  ~OpenedFiles() { ::close(events_); }

  /// How often each file was opened since the last call, by its name. Files that were not opened are left out.
  std::map<std::string, int> count() {
    std::map<std::string, int> opened;
    alignas(inotify_event) std::array<char, 1 << 16> bytes{};
    for (ssize_t size = 0; (size = ::read(events_, bytes.data(), bytes.size())) > 0;) {
      for (ssize_t at = 0; at < size;) {
        const auto* const event = reinterpret_cast<const inotify_event*>(bytes.data() + at);
        if (event->len > 0 && (event->mask & IN_ISDIR) == 0) ++opened[event->name];
        at += static_cast<ssize_t>(sizeof(inotify_event) + event->len);
      }
    }
    return opened;
  }

 private:
  int events_;
};

}  // namespace palpate::plugin::testing
