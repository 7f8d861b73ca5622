#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <sys/resource.h>
#include <unistd.h>

#include <array>
#include <filesystem>
#include <fstream>
#include <functional>
#include <string>
#include <vector>

#include "io/dicom/input_file.h"
#include "io/load.h"
#include "io/series.h"
#include "io/testing/test_coders.h"
#include "plugin/messages/provoked.h"
#include "plugin/messages/provoked_scans.h"
#include "testdata/sanitized.h"

namespace palpate::plugin::testing {
namespace {

namespace fs = std::filesystem;
using namespace io::internal;

/// A stack of which something becomes of a file between its header and its pixels.
std::string of_stack_that_changes(const std::function<void(const fs::path& slice)>& change) {
  const TestFolder folder;
  write_stack(folder.path(), 5);
  return said_of(folder.path(), [&] { change(folder / "s2.dcm"); });
}

/// A file that becomes shorter while it is read.
std::string of_a_shrinking_file() {
  const TestFolder folder;
  write_bytes(folder / "a", std::string(100, 'x'));
  const InputFile file(folder / "a");
  fs::resize_file(folder / "a", 10);
  return said_when([&] {
    std::array<std::byte, 100> bytes{};
    file.read(0, bytes);
  });
}

/// A folder that only another user may list: root may list all, so that it has to be nobody for a moment.
std::string of_a_locked_folder() {
  const TestFolder folder;
  constexpr uid_t nobody = 65534;
  const bool is_root = ::geteuid() == 0;
  fs::permissions(folder.path(), fs::perms::none);
  if (is_root && ::seteuid(nobody) != 0) return "cannot become another user";
  const std::string said = said_when([&] { io::find_series(std::array{folder.path()}); });
  if (is_root && ::seteuid(0) != 0) return "cannot become root again";
  fs::permissions(folder.path(), fs::perms::owner_all);
  return said;
}

constexpr const char* too_large = "{} needs more memory than there is: {} MiB; close other programs first";

/// Two slices of 60000 x 60000, in files of a hole each, where 2 GiB more are all there is. Sanitizers end a program
/// that asks for too much.
std::string of_too_large_a_scan() {
  const TestFolder folder;
  write_stack(folder.path(), 2, [](int, TestImage& image) {
    image.syntax = EXS_RLELossless;
    image.edit = [](DcmDataset& d) {
      put(d, DCM_Rows, 60000);
      put(d, DCM_Columns, 60000);
      encapsulate(d, EXS_RLELossless, {std::vector<Uint8>(15'000'000)}, 1U << 30);
    };
  });
  const io::Series series = io::find_series(std::array{folder.path()}).series.at(0);
  rlimit before{};
  ::getrlimit(RLIMIT_AS, &before);
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlimit little{pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + (2UL << 30), before.rlim_max};
  ::setrlimit(RLIMIT_AS, &little);
  const std::string said = said_when([&] { io::load(series); });
  ::setrlimit(RLIMIT_AS, &before);
  return said;
}

/// Velocities along three directions, of which one loses a slice between its header and its pixels.
std::string of_velocities_that_differ() {
  const TestFolder folder;
  for (const char* const name : {"*fl3d1_v80rl", "*fl3d1_v80ap", "*fl3d1_v80hf"}) {
    fs::create_directory(folder / name);
    write_stack(folder / name, 3, [&](int, TestImage& image) {
      image.series = std::string("1.2.3.") + std::to_string(name[10]);
      image.edit = [&](DcmDataset& d) { put(d, DCM_SequenceName, std::string(name)); };
    });
  }
  return said_of(folder.path(), [&] { fs::remove(folder / "*fl3d1_v80ap" / "s0.dcm"); });
}

std::string of_frames_of_which_one_lacks_a_slice() {
  return said_of([](const TestFolder& folder) {
    for (int n = 0; n < 10; ++n) {
      if (n == 7) continue;
      TestImage image;
      image.z = 2.0 * (n % 5);
      image.edit = [n](DcmDataset& d) { put(d, DCM_TemporalPositionIdentifier, std::to_string(n / 5 + 1)); };
      write(image, folder / std::to_string(n));
    }
  });
}

std::string of_a_stack_and(const std::function<void(DcmDataset&)>& edit) {
  return said_of([&](const TestFolder& folder) {
    write_stack(folder.path(), 6);
    TestImage another;
    another.z = 4;
    another.edit = edit;
    write(another, folder / "z.dcm");
  });
}

std::vector<Provoked> provoke_series(const io::Series& series) {
  std::vector<Provoked> provoked{
      {"no such file or folder: {}; check its name",
       said_when([] { io::find_series(std::array<fs::path, 1>{"/absent"}); })},
      {"cannot list {}: {}; it has to be yours to read", of_a_locked_folder()},
      {"cannot be opened: check that it exists and may be read",
       of_stack_that_changes([](const fs::path& slice) { fs::remove(slice); })},
      {"cannot be read to its end", of_a_shrinking_file()},
      {"{} has frames 0 to {}, not {}", said_when([&] { io::load(series, {.frame = 3}); })},
      {"{} has slices 0 to {}, not {}", said_when([&] {
         io::load(series, {.slices = {{2, 9}}});
       })},
      {"{} cannot be loaded: {}", said_when([] { io::load(io::Series()); })},
      {"it has no readable images", said_when([] { io::load(io::Series()); })},
      {"the three directions of the velocity do not hold the same slices: send the series again",
       of_velocities_that_differ()},
      {"frame {} has {} slices, not {}", of_frames_of_which_one_lacks_a_slice()},
      {"another image of its series lies at its position and nothing tells them apart", of_a_stack_and([](auto&) {})},
      {"{} is left out: another image lies at its position", of_a_stack_and([](auto&) {})},
      {"does not fit the volume of its series ({})",
       of_a_stack_and([](DcmDataset& d) { put(d, DCM_ImageOrientationPatient, std::string("1\\0\\0\\0\\0\\-1")); })},
  };
  if (!testdata::is_sanitized) provoked.push_back({too_large, of_too_large_a_scan()});
  return provoked;
}

}  // namespace

std::vector<Provoked> provoke_files() {
  const TestFolder whole;
  write_stack(whole.path(), 4);
  const io::Series series = io::find_series(std::array{whole.path()}).series.front();
  std::vector<Provoked> said{
      {"DICOMDIR: an index; the files themselves are looked at",
       of_image([](DcmDataset& d) { d.insertEmptyElement(DCM_DirectoryRecordSequence); })},
      {"{}: no pixels in it", of_image([](DcmDataset& d) { d.findAndDeleteElement(DCM_PixelData); })},
      {"{}: no image in it", of_image([](DcmDataset& d) { put(d, DCM_Rows, 0); })},
      {"color image ({}): it has no values to feel",
       of_image([](DcmDataset& d) { put(d, DCM_PhotometricInterpretation, std::string("RGB")); })},
      {"pixels of {} bits in {}, the highest of them bit {}, cannot be read",
       of_image([](DcmDataset& d) { put(d, DCM_BitsStored, 40); })},
      {"no position in the patient (ImagePositionPatient, ImageOrientationPatient, PixelSpacing)",
       of_image([](DcmDataset& d) { d.findAndDeleteElement(DCM_ImagePositionPatient); })},
      {"one slice alone is no volume", of_image([](DcmDataset&) {})},
      {"a localizer, no volume", of_stack(3,
                                          [](int, TestImage& image) {
                                            image.edit = [](DcmDataset& d) {
                                              put(d, DCM_ImageType, std::string("ORIGINAL\\PRIMARY\\LOCALIZER"));
                                            };
                                          })},
      {"a copy of {}: the same SOP instance", said_of([](const TestFolder& folder) {
         write_stack(folder.path(), 3);
         fs::copy_file(folder / "s1.dcm", folder / "again.dcm");
       })},
      {"{} slice is missing between slices {} and {} ({} apart, elsewhere {}): nothing is felt there",
       of_stack(8, [](int k, TestImage& image) { image.z += k > 3 ? 2 : 0; })},
      {"{} slices are missing between", of_stack(8, [](int k, TestImage& image) { image.z += k > 3 ? 4 : 0; })},
      {"slices are unevenly spaced, {} to {} apart: each is used where it is",
       of_stack(6, [](int k, TestImage& image) { image.z += k % 2 ? 0.4 : 0; })},
      {"{} is left out: {}", said_of([](const TestFolder& folder) {
         write_stack(folder.path(), 5);
         const std::string bytes = bytes_of(folder / "s2.dcm");
         write_bytes(folder / "s2.dcm", bytes.substr(0, bytes.size() - 10));
       })},
      {"none of its images can be read", said_of([](const TestFolder& folder) {
         write_stack(folder.path(), 3);
         for (const char* const name : {"s0.dcm", "s1.dcm", "s2.dcm"}) {
           const std::string bytes = bytes_of(folder / name);
           write_bytes(folder / name, bytes.substr(0, bytes.size() - 10));
         }
       })},
      {"its values need a modality look-up table, which is not applied here", of_image([](DcmDataset& d) {
         DcmItem* item = nullptr;
         d.findOrCreateSequenceItem(DCM_ModalityLUTSequence, item, -2);
       })},
      {"several frames without a position for each", of_image([](DcmDataset& d) {
         put(d, DCM_NumberOfFrames, std::string("2"));
         repeat_pixels(d, 2);
       })},
      {"pixels that are floating-point numbers cannot be read", of_image([](DcmDataset& d) {
         d.findAndDeleteElement(DCM_PixelData);
         const std::vector<Float32> pixels(24);
         succeed(d.putAndInsertFloat32Array(DcmTag(0x7FE0, 0x0008, EVR_OF), pixels.data(), pixels.size()));
       })},
      {"its rescale slope or intercept is no number",
       of_image([](DcmDataset& d) { put(d, DCM_RescaleSlope, std::string("two")); })},
      {"its rescale slope is 0: it says that all values are the same",
       of_image([](DcmDataset& d) { put(d, DCM_RescaleSlope, std::string("0")); })},
      {"Siemens mosaic without the private header that says how to take it apart",
       of_image([](DcmDataset& d) { put(d, DCM_ImageType, std::string("ORIGINAL\\PRIMARY\\M\\MOSAIC")); })},
      {"slices are displaced sideways against each other: each is used where it is",
       of_stack(6,
                [](int k, TestImage& image) {
                  image.edit = [k](DcmDataset& d) {
                    const std::string place = std::to_string(k % 2) + "\\0\\" + std::to_string(2 * k);
                    put(d, DCM_ImagePositionPatient, place);
                  };
                })},
  };
  const std::vector<Provoked> more = provoke_series(series);
  said.insert(said.end(), more.begin(), more.end());
  return said;
}

}  // namespace palpate::plugin::testing
