#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <dcmtk/dcmdata/dcuid.h>
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
#include "io/testing/provoked_scans.h"
#include "io/testing/test_coders.h"
#include "solver/text/testing/sanitized.h"

namespace palpate::io::testing {
namespace {

namespace fs = std::filesystem;
using namespace internal;

/// A stack in which a file changes between the reading of its header and its pixels.
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

/// A folder that only another user may list. Root may list all folders, so root becomes `nobody` for a moment.
std::string of_a_locked_folder() {
  const TestFolder folder;
  constexpr uid_t nobody = 65534;
  const bool is_root = ::geteuid() == 0;
  fs::permissions(folder.path(), fs::perms::none);
  if (is_root) {  // as whom the way there need not be open to others
    fs::permissions(folder.path().parent_path(), fs::perms::group_exec | fs::perms::others_exec, fs::perm_options::add);
  }
  if (is_root && ::seteuid(nobody) != 0) return "cannot become another user";
  const std::string said = said_when([&] { find_series(std::array{folder.path()}); });
  if (is_root && ::seteuid(0) != 0) return "cannot become root again";
  fs::permissions(folder.path(), fs::perms::owner_all);
  return said;
}

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
  const Series series = find_series(std::array{folder.path()}).series.at(0);
  rlimit before{};
  ::getrlimit(RLIMIT_AS, &before);
  std::size_t pages = 0;
  std::ifstream("/proc/self/statm") >> pages;
  const rlimit little{pages * static_cast<rlim_t>(::sysconf(_SC_PAGESIZE)) + (2UL << 30), before.rlim_max};
  ::setrlimit(RLIMIT_AS, &little);
  const std::string said = said_when([&] { load(series); });
  ::setrlimit(RLIMIT_AS, &before);
  return said;
}

/// Velocities along three directions, one of which loses a slice between the reading of header and pixels.
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

/// A stack, and one of its files once more with other bytes at its end.
std::string of_another_copy(const std::function<std::string(std::string)>& change) {
  return said_of([&](const TestFolder& folder) {
    write_stack(folder.path(), 3);
    write_bytes(folder / "again.dcm", change(bytes_of(folder / "s1.dcm")));
  });
}

std::string cut(const std::string& bytes) {
  return bytes.substr(0, bytes.size() - 10);
}
std::string changed_at_its_end(std::string bytes) {
  bytes.back() = static_cast<char>(bytes.back() ^ 1);
  return bytes;
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

std::vector<Provoked> provoke_series(const Series& series) {
  std::vector<Provoked> provoked{
      {"no-such-file-or-folder", said_when([] { find_series(std::array<fs::path, 1>{"/absent"}); })},
      {"cannot-list", of_a_locked_folder()},
      {"cannot-be-opened", of_stack_that_changes([](const fs::path& slice) { fs::remove(slice); })},
      {"cannot-be-read-to-its-end", of_a_shrinking_file()},
      {"no-such-frame", said_when([&] { load(series, {.frame = 3}); })},
      {"no-such-slice", said_when([&] {
         load(series, {.slices = {{2, 9}}});
       })},
      {"series-cannot-be-loaded", said_when([] { load(Series()); })},
      {"no-readable-images", said_when([] { load(Series()); })},
      {"velocity-directions-differ", of_velocities_that_differ()},
      {"velocities-may-be-reversed", of_velocities_that_differ()},
      {"damaged-copy", of_another_copy(cut)},
      {"copy-with-other-pixels", of_another_copy(changed_at_its_end)},
      {"used-and-not-its-copy", of_another_copy(changed_at_its_end)},
      {"one-uid-for-several-images", of_stack(3,
                                              [](int, TestImage& image) {
                                                image.edit = [](DcmDataset& d) {
                                                  put(d, DCM_SOPInstanceUID, std::string("1.2.3.4.5"));
                                                };
                                              })},
      {"some-frames-have-no-place", of_image([](DcmDataset& d) {
         make_multi_frame(d, {0, 2});
         put(d, DCM_NumberOfFrames, std::string("3"));
         repeat_pixels(d, 3);
       })},
      {"values-may-not-be-hounsfield-units", of_stack(3,
                                                      [](int, TestImage& image) {
                                                        image.edit = [](DcmDataset& d) {
                                                          put(d, DCM_Modality, std::string("CT"));
                                                          put(d, DCM_RescaleType, std::string("US"));
                                                        };
                                                      })},
      {"frame-lacks-slices", of_frames_of_which_one_lacks_a_slice()},
      {"another-image-of-its-series-lies", of_a_stack_and([](auto&) {})},
      {"left-out-same-position", of_a_stack_and([](auto&) {})},
      {"does-not-fit-the-volume",
       of_a_stack_and([](DcmDataset& d) { put(d, DCM_ImageOrientationPatient, std::string("1\\0\\0\\0\\0\\-1")); })},
  };
  if (!is_sanitized) provoked.push_back({"needs-more-memory-than-there", of_too_large_a_scan()});
  return provoked;
}

}  // namespace

std::vector<Provoked> provoke_files() {
  const TestFolder whole;
  write_stack(whole.path(), 4);
  const Series series = find_series(std::array{whole.path()}).series.front();
  std::vector<Provoked> said{
      {"dicomdir-an-index", of_image([](DcmDataset& d) { d.insertEmptyElement(DCM_DirectoryRecordSequence); })},
      {"no-pixels", of_image([](DcmDataset& d) { d.findAndDeleteElement(DCM_PixelData); })},
      {"no-image", of_image([](DcmDataset& d) { put(d, DCM_Rows, 0); })},
      {"color-image-it-has-no-values",
       of_image([](DcmDataset& d) { put(d, DCM_PhotometricInterpretation, std::string("RGB")); })},
      {"pixels-of-bits", of_image([](DcmDataset& d) { put(d, DCM_BitsStored, 40); })},
      {"no-position-in-the-patient", of_image([](DcmDataset& d) { d.findAndDeleteElement(DCM_ImagePositionPatient); })},
      {"position-beyond-any-patient",
       of_image([](DcmDataset& d) { put(d, DCM_ImagePositionPatient, std::string("0\\0\\1e30")); })},
      {"one-slice-alone-is-no-volume", of_image([](DcmDataset&) {})},
      {"localizer-no-volume", of_stack(3,
                                       [](int, TestImage& image) {
                                         image.edit = [](DcmDataset& d) {
                                           put(d, DCM_ImageType, std::string("ORIGINAL\\PRIMARY\\LOCALIZER"));
                                         };
                                       })},
      {"copy-of-an-image", said_of([](const TestFolder& folder) {
         write_stack(folder.path(), 3);
         fs::copy_file(folder / "s1.dcm", folder / "again.dcm");
       })},
      {"slice-is-missing-between-slices", of_stack(8, [](int k, TestImage& image) { image.z += k > 3 ? 2 : 0; })},
      {"slices-are-missing-between", of_stack(8, [](int k, TestImage& image) { image.z += k > 3 ? 4 : 0; })},
      {"slices-are-unevenly-spaced", of_stack(6, [](int k, TestImage& image) { image.z += k % 2 ? 0.4 : 0; })},
      {"left-out", said_of([](const TestFolder& folder) {
         write_stack(folder.path(), 5);
         const std::string bytes = bytes_of(folder / "s2.dcm");
         write_bytes(folder / "s2.dcm", bytes.substr(0, bytes.size() - 10));
       })},
      {"none-of-its-images-can-be-read", said_of([](const TestFolder& folder) {
         write_stack(folder.path(), 3);
         for (const char* const name : {"s0.dcm", "s1.dcm", "s2.dcm"}) {
           const std::string bytes = bytes_of(folder / name);
           write_bytes(folder / name, bytes.substr(0, bytes.size() - 10));
         }
       })},
      {"modality-look-up-table-is-damaged", of_image([](DcmDataset& d) {
         DcmItem* item = nullptr;
         d.findOrCreateSequenceItem(DCM_ModalityLUTSequence, item, -2);
       })},
      {"several-frames-without-a-position-for-each", of_image([](DcmDataset& d) {
         put(d, DCM_NumberOfFrames, std::string("2"));
         repeat_pixels(d, 2);
       })},
      {"real-world-values-need-a-table", of_image([](DcmDataset& d) {
         make_multi_frame(d, {0, 2},
                          [](std::size_t, DcmItem& frame) { group(frame, DCM_RealWorldValueMappingSequence); });
         put(d, DCM_SOPClassUID, std::string(UID_ParametricMapStorage));
         repeat_pixels(d, 2);
       })},
      {"rescale-is-no-number", of_image([](DcmDataset& d) { put(d, DCM_RescaleSlope, std::string("two")); })},
      {"rescale-slope-is-0", of_image([](DcmDataset& d) { put(d, DCM_RescaleSlope, std::string("0")); })},
      {"siemens-mosaic-without-the-private-header",
       of_image([](DcmDataset& d) { put(d, DCM_ImageType, std::string("ORIGINAL\\PRIMARY\\M\\MOSAIC")); })},
      {"slices-displaced-sideways", of_stack(6,
                                             [](int k, TestImage& image) {
                                               image.edit = [k](DcmDataset& d) {
                                                 const std::string place =
                                                     std::to_string(k % 2) + "\\0\\" + std::to_string(2 * k);
                                                 put(d, DCM_ImagePositionPatient, place);
                                               };
                                             })},
  };
  const std::vector<Provoked> more = provoke_series(series);
  said.insert(said.end(), more.begin(), more.end());
  return said;
}

}  // namespace palpate::io::testing
