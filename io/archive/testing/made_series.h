#pragma once

/// Series for the tests of archives, generated: each a study and a patient of its own.

#include <filesystem>
#include <string>

namespace palpate::io::testing {

inline const std::string ct = "ct_4", compressed = "mr_jpeg_lossless_4", brain = "mr_20";
inline const std::string another_mr = "mr_35", another_ct = "another_ct_4";  ///< in no archive before they are sent

/// The folder that holds a folder of each; made when it is asked for first, and removed at the end.
const std::filesystem::path& made_series();

}  // namespace palpate::io::testing
