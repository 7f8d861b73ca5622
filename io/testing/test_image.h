#pragma once

/// Small DICOM files for the tests of the reader, written by DCMTK: one image a file. Every attribute can be changed.

#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdatset.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <unistd.h>

#include <filesystem>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

#include "io/load.h"
#include "io/series.h"

namespace palpate::io::internal {

/// A new folder below the system's temporary folder. It is removed with its owner.
class TestFolder {
 public:
  TestFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "palpate_io_XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error("cannot make " + name);
    path_ = name;
  }
  TestFolder(const TestFolder&) = delete;
  TestFolder& operator=(const TestFolder&) = delete;
  ~TestFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  const std::filesystem::path& path() const { return path_; }
  std::filesystem::path operator/(const std::string& name) const { return path_ / name; }

 private:
  std::filesystem::path path_;
};

void succeed(const OFCondition& condition);  ///< throws if it is not good

/// An image of 6 columns and 4 rows by default, whose stored value at (i, j) is `value(i, j)`.
struct TestImage {
  int columns = 6;
  int rows = 4;
  double z = 0;                    ///< of its position (0, 0, z)
  std::string series = "1.2.3.4";  ///< SeriesInstanceUID
  std::string instance;            ///< SOPInstanceUID; empty: a new one
  std::function<int(int, int)> value = [](int i, int j) { return 10 * i + j; };
  /// Called last: adds, changes or removes attributes.
  std::function<void(DcmDataset&)> edit = [](DcmDataset&) {};
  E_TransferSyntax syntax = EXS_LittleEndianExplicit;
};

std::string numbered(const std::string& name, int number);

void put(DcmDataset& dataset, const DcmTagKey& tag, const std::string& text);
void put(DcmDataset& dataset, const DcmTagKey& tag, int value);  ///< as US

void fill(DcmDataset& dataset, const TestImage& image);
void write(const TestImage& image, const std::filesystem::path& path);

/// `count` slices 2 mm apart, s0.dcm upwards, with values 100 k + 10 i + j; each image edited by `change` first.
void write_stack(
    const std::filesystem::path& folder, int count,
    const std::function<void(int, TestImage&)>& change = [](int, TestImage&) {});

/// The series that the reader finds there.
Catalogue find_in(const TestFolder& folder);
/// The only series there. If there is none, or several, throws with the reasons for skipped files.
Series only_series_in(const TestFolder& folder);
Volume load_frame(const Series& series, int frame);

/// Makes the dataset an enhanced one with a frame for each height z (mm), in this order. Orientation and spacing stay.
/// `frame` may add to a frame's functional groups.
void make_multi_frame(
    DcmDataset& dataset, const std::vector<double>& heights,
    const std::function<void(std::size_t, DcmItem&)>& frame = [](std::size_t, DcmItem&) {});
/// Repeats the dataset's pixels for each frame.
void repeat_pixels(DcmDataset& dataset, std::size_t frames);
/// The item of a functional group. It is made if it does not exist.
DcmItem& group(DcmItem& item, const DcmTagKey& sequence);

}  // namespace palpate::io::internal
