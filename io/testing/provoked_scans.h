#pragma once

/// Folders of small DICOM files with faults, and the reader's messages about them.

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"
#include "solver/text/testing/shown.h"

namespace palpate::io::testing {

using internal::bytes_of;
using internal::TestFolder;
using internal::TestImage;
using internal::write_bytes;
using palpate::testing::Provoked;
using palpate::testing::said_when;

/// All messages about a folder: reasons for skipped files, notes on its series, and why the first series cannot be
/// loaded. `between` is called after the headers are read and before the pixels are.
std::string said_of(
    const std::filesystem::path& folder, const std::function<void()>& between = [] {});
/// The messages about a folder that `fill` fills.
std::string said_of(const std::function<void(const TestFolder&)>& fill);

/// The messages about one image after its file's bytes were edited.
std::string of_bytes(const std::function<std::string(std::string)>& damage);
/// The messages about one image after its attributes were edited.
std::string of_image(const std::function<void(DcmDataset&)>& edit);
/// The messages about a stack of so many slices, 2 mm apart.
std::string of_stack(int count, const std::function<void(int, TestImage&)>& change);

/// Each refusal of the reader, provoked by an input.
std::vector<Provoked> provoke_files();
std::vector<Provoked> provoke_headers();
std::vector<Provoked> provoke_pixels();
std::vector<Provoked> provoke_archives();

}  // namespace palpate::io::testing
