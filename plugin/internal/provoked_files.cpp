#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcpixel.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>

#include <array>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "palpate/io/internal/test_image.h"
#include "palpate/io/load.h"
#include "palpate/io/series.h"
#include "palpate/plugin/internal/provoked.h"

namespace palpate::plugin::testing {
namespace {

namespace fs = std::filesystem;
using namespace io::internal;

/// What is said of a folder: why files were set apart, notes on its series, and why the first cannot be loaded.
std::string said_of(const fs::path& folder) {
  std::string said;
  const auto catalogue = io::find_series(std::array{folder});
  for (const io::SkippedFile& file : catalogue.skipped) said += file.reason + "\n";
  for (const io::Series& series : catalogue.series) {
    for (const std::string& warning : series.warnings) said += warning + "\n";
    try {
      for (const std::string& warning : io::load(series).warnings) said += warning + "\n";
    } catch (const std::exception& error) {
      said += std::string(error.what()) + "\n";
    }
  }
  return said;
}

std::string said_of(const std::function<void(const TestFolder&)>& fill) {
  const TestFolder folder;
  fill(folder);
  return said_of(folder.path());
}

std::string bytes_of(const fs::path& file) {
  std::ifstream stream(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

void write_bytes(const fs::path& file, const std::string& bytes) {
  std::ofstream(file, std::ios::binary) << bytes;
}

std::string of_bytes(const std::function<std::string(std::string)>& damage) {
  return said_of([&](const TestFolder& folder) {
    write({}, folder / "a.dcm");
    write_bytes(folder / "a.dcm", damage(bytes_of(folder / "a.dcm")));
  });
}

/// One image, edited.
std::string of_image(const std::function<void(DcmDataset&)>& edit) {
  return said_of([&](const TestFolder& folder) {
    TestImage image;
    image.edit = edit;
    write(image, folder / "a.dcm");
  });
}

std::string of_stack(int count, const std::function<void(int, TestImage&)>& change) {
  return said_of([&](const TestFolder& folder) { write_stack(folder.path(), count, change); });
}

/// A stack whose compressed pixels are that many bytes of nothing.
std::string of_pixels(E_TransferSyntax syntax, std::size_t bytes) {
  return of_stack(3, [&](int, TestImage& image) {
    image.syntax = syntax;
    image.edit = [=](DcmDataset& dataset) {
      auto sequence = std::make_unique<DcmPixelSequence>(DCM_PixelSequenceTag);
      succeed(sequence->insert(new DcmPixelItem(DCM_PixelItemTag)));
      auto item = std::make_unique<DcmPixelItem>(DCM_PixelItemTag);
      const std::vector<Uint8> nothing(bytes, 7);
      succeed(item->putUint8Array(nothing.data(), static_cast<unsigned long>(bytes)));
      succeed(sequence->insert(item.release()));
      auto pixels = std::make_unique<DcmPixelData>(DCM_PixelData);
      pixels->putOriginalRepresentation(syntax, nullptr, sequence.release());
      succeed(dataset.insert(pixels.release(), OFTrue));
    };
  });
}

std::string said_when(const std::function<void()>& run) {
  try {
    run();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "nothing";
}

}  // namespace

std::vector<Provoked> provoke_files() {
  const TestFolder whole;
  write_stack(whole.path(), 4);
  const io::Series series = io::find_series(std::array{whole.path()}).series.front();
  return {
      {"no such file or folder: {}; check its name",
       said_when([] { io::find_series(std::array<fs::path, 1>{"/absent"}); })},
      {"{} has frames 0 to {}, not {}", said_when([&] { io::load(series, {.frame = 3}); })},
      {"empty file", of_bytes([](const std::string&) { return std::string(); })},
      {"not a DICOM file", of_bytes([](const std::string&) { return std::string(600, 'x'); })},
      {"truncated in its header", of_bytes([](const std::string& b) { return b.substr(0, b.find("1.2.3.4") + 3); })},
      {"truncated: {} of {} bytes of pixels",
       of_bytes([](const std::string& b) { return b.substr(0, b.size() - 10); })},
      {"damaged: no dataset in it",
       of_bytes([](const std::string& b) { return b.substr(0, 200) + std::string(200, '\xee'); })},
      {"DICOMDIR: an index; the files themselves are looked at",
       of_image([](DcmDataset& d) { d.insertEmptyElement(DCM_DirectoryRecordSequence); })},
      {"{}: no pixels in it", of_image([](DcmDataset& d) { d.findAndDeleteElement(DCM_PixelData); })},
      {"{}: no image in it", of_image([](DcmDataset& d) { put(d, DCM_Rows, 0); })},
      {"colour image ({}): it has no values to feel",
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
      {"{} cannot be read: {}; send the series again", of_pixels(EXS_RLELossless, 10)},
      {"damaged: its RLE segments {}", of_pixels(EXS_RLELossless, 10)},
      {"are missing", of_pixels(EXS_RLELossless, 10)},
      {"are not one a byte of a pixel", of_pixels(EXS_RLELossless, 100)},
      {"damaged: no JPEG image in its compressed pixels", of_pixels(EXS_JPEGProcess14SV1, 100)},
      {"damaged: its JPEG-LS image cannot be decoded ({})", of_pixels(EXS_JPEGLSLossless, 100)},
      {"damaged: its JPEG 2000 image {}", of_pixels(EXS_JPEG2000LosslessOnly, 100)},
      {"has no readable header", of_pixels(EXS_JPEG2000LosslessOnly, 100)},
      {"its compression is unknown here: {}", of_pixels(EXS_MPEG2MainProfileAtMainLevel, 100)},
      {"its values need a modality look-up table, which is not applied here", of_image([](DcmDataset& d) {
         DcmItem* item = nullptr;
         d.findOrCreateSequenceItem(DCM_ModalityLUTSequence, item, -2);
       })},
      {"several frames without a position for each", of_image([](DcmDataset& d) {
         put(d, DCM_NumberOfFrames, std::string("2"));
         repeat_pixels(d, 2);
       })},
  };
}

}  // namespace palpate::plugin::testing
