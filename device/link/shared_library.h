#pragma once

/// A maker's library, loaded at run time: building and starting the program do not need it.

#include <span>
#include <string>
#include <utility>
#include <vector>

namespace palpate::device {

class SharedLibrary {
 public:
  /// Loads the first of these files that can be loaded. Throws std::runtime_error that begins with `device` and lists
  /// the files tried, the loader's error and, as `advice`, what to install. The library stays loaded until the program
  /// ends: makers' drivers fail when they are loaded twice.
  SharedLibrary(const std::string& device, std::span<const std::string> files, const std::string& advice);

  /// Puts the address of the function of this name into `function`. Throws std::runtime_error if there is none.
  template <typename Function>
  void find(const char* name, Function*& function) const {
    function = reinterpret_cast<Function*>(address_of(name));
  }
  /// Puts null if there is none.
  template <typename Function>
  void find_if_there(const char* name, Function*& function) const noexcept {
    function = reinterpret_cast<Function*>(look_up(name));
  }
  const std::string& file() const noexcept { return file_; }

 private:
  void* look_up(const char* name) const noexcept;
  void* address_of(const char* name) const;

  std::string device_;
  std::string advice_;
  std::string file_;
  void* handle_ = nullptr;
};

/// The files to try: the one that the environment variable `variable` names, or else the usual ones.
std::vector<std::string> library_candidates(const char* variable, std::vector<std::string> usual);

}  // namespace palpate::device
