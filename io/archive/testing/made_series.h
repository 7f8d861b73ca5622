#pragma once

/// Generated series for the tests of archives; each is a study and a patient of its own.

#include <filesystem>
#include <string>

namespace palpate::io::testing {

inline const std::string ct = "ct_4", compressed = "mr_jpeg_lossless_4", brain = "mr_20";
inline const std::string another_mr = "mr_35", another_ct = "another_ct_4";  ///< in no archive until a test sends them

/// The folder with a subfolder for each series; made on the first call, and removed at the end of the program.
const std::filesystem::path& made_series();

}  // namespace palpate::io::testing
