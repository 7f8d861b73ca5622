#pragma once

namespace palpate::plugin {

/// The text of --version: Palpate's version, its commit if known, and the versions of its libraries.
const char* version_text() noexcept;

}  // namespace palpate::plugin
