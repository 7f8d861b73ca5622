#pragma once

namespace palpate::plugin {

/// What --version says: Palpate's version, the commit it was built from where that is known, and its libraries'.
const char* version_text() noexcept;

}  // namespace palpate::plugin
