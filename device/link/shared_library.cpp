#include "device/link/shared_library.h"

#include <dlfcn.h>

#include <cstdlib>
#include <stdexcept>

#include "device/messages.h"

namespace palpate::device {

SharedLibrary::SharedLibrary(const std::string& device, std::span<const std::string> files, const std::string& advice)
    : device_(device), advice_(advice) {
  std::string said;
  for (const std::string& file : files) {
    handle_ = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL | RTLD_NODELETE);
    if (handle_ != nullptr) {
      file_ = file;
      return;
    }
    const char* const why = dlerror();
    said += (said.empty() ? "" : "; ") + std::string(why != nullptr ? why : file.c_str());
  }
  throw Refusal(say("maker-library-cannot-be-loaded", device_, said, advice_));
}

void* SharedLibrary::look_up(const char* name) const noexcept {
  return dlsym(handle_, name);
}

void* SharedLibrary::address_of(const char* name) const {
  void* const address = look_up(name);
  if (address == nullptr) {
    throw Refusal(say("library-is-another-version", device_, file_, name, advice_));
  }
  return address;
}

std::vector<std::string> library_candidates(const char* variable, std::vector<std::string> usual) {
  const char* const named = std::getenv(variable);
  if (named != nullptr && *named != '\0') return {named};
  return usual;
}

}  // namespace palpate::device
