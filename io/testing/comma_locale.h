#pragma once

/// A locale with a decimal comma (0,75), as a host program may have set it.

#include <clocale>
#include <cstdlib>
#include <string>

#include "io/testing/test_image.h"

namespace palpate::io::internal {

/// Sets the locale until it is destroyed. Debian's localedef makes it, since few machines have one installed.
class CommaLocale {
 public:
  CommaLocale() {
    const std::string make = "localedef -i de_DE -f UTF-8 " + (folder_ / "de_DE.UTF-8").string() + " >/dev/null 2>&1";
    if (std::system(make.c_str()) != 0) return;  // NOLINT(cert-env33-c)
    ::setenv("LOCPATH", folder_.path().c_str(), 1);
    is_set_ = std::setlocale(LC_ALL, "de_DE.UTF-8") != nullptr && *std::localeconv()->decimal_point == ',';
  }
  CommaLocale(const CommaLocale&) = delete;
  CommaLocale& operator=(const CommaLocale&) = delete;
  ~CommaLocale() {
    std::setlocale(LC_ALL, "C");
    ::unsetenv("LOCPATH");
  }
  /// False if this machine cannot make it.
  bool is_set() const { return is_set_; }
  static constexpr const char* needed =
      "needs a locale that writes 0,75, and localedef (Debian's locales) or setlocale() does not make or take de_DE "
      "here";

 private:
  TestFolder folder_;
  bool is_set_ = false;
};

}  // namespace palpate::io::internal
