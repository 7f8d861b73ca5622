#pragma once

/// Output on stdout, with control characters made visible, so that a terminal does not obey them
/// (solver/text/printable.h).

#include <fmt/format.h>

#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

#include "solver/text/printable.h"

namespace palpate::plugin {

template <typename... Values>
void put(fmt::format_string<Values...> text, Values&&... values) {
  std::fputs(printable(fmt::format(text, std::forward<Values>(values)...)).c_str(), stdout);
}

/// JSON as text, followed by a line end.
inline void put_json_text(std::string_view json, const char* end = "\n") {
  std::fputs(printable_json(json).append(end).c_str(), stdout);
}

/// JSON, with a line end. Text that is not UTF-8 (a file's name may be in any encoding) is replaced.
template <typename Json>
void put_json(const Json& json, int indent = -1) {
  put_json_text(json.dump(indent, ' ', false, Json::error_handler_t::replace));
}

}  // namespace palpate::plugin
