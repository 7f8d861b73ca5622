#pragma once

/// Generated series for the tests of archives. Each is a study of another patient.

#include <filesystem>
#include <string>

namespace palpate::io::testing {

inline const std::string ct = "ct_4", compressed = "mr_jpeg_lossless_4", brain = "mr_20";
inline const std::string another_mr = "mr_35", another_ct = "another_ct_4";  ///< in no archive before they are sent

/// The folder with a subfolder for each. It is made at the first call, and removed at the end.
const std::filesystem::path& made_series();

}  // namespace palpate::io::testing
