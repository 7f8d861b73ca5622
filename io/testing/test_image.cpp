#include "io/testing/test_image.h"

#include <dcmtk/dcmdata/dcfilefo.h>
#include <dcmtk/dcmdata/dcuid.h>

#include <array>
#include <vector>

namespace palpate::io::internal {

void succeed(const OFCondition& condition) {
  if (condition.bad()) throw std::runtime_error(condition.text());
}

std::string numbered(const std::string& name, int number) {
  return name + std::to_string(number);
}

void put(DcmDataset& dataset, const DcmTagKey& tag, const std::string& text) {
  succeed(dataset.putAndInsertString(tag, text.c_str()));
}
void put(DcmDataset& dataset, const DcmTagKey& tag, int value) {
  succeed(dataset.putAndInsertUint16(tag, static_cast<Uint16>(value)));
}

void fill(DcmDataset& dataset, const TestImage& image) {
  static int count = 0;
  put(dataset, DCM_SOPClassUID, UID_CTImageStorage);
  put(dataset, DCM_SOPInstanceUID, image.instance.empty() ? numbered("1.2.3.9.", ++count) : image.instance);
  put(dataset, DCM_StudyInstanceUID, "1.2.3");
  put(dataset, DCM_SeriesInstanceUID, image.series);
  put(dataset, DCM_Modality, "CT");
  put(dataset, DCM_ImageType, "ORIGINAL\\PRIMARY\\AXIAL");
  put(dataset, DCM_ImagePositionPatient, std::string("0\\0\\") + std::to_string(image.z));
  put(dataset, DCM_ImageOrientationPatient, "1\\0\\0\\0\\1\\0");
  put(dataset, DCM_PixelSpacing, "0.5\\0.75");
  put(dataset, DCM_SliceThickness, "2");
  put(dataset, DCM_SamplesPerPixel, 1);
  put(dataset, DCM_PhotometricInterpretation, "MONOCHROME2");
  put(dataset, DCM_Rows, image.rows);
  put(dataset, DCM_Columns, image.columns);
  put(dataset, DCM_BitsAllocated, 16);
  put(dataset, DCM_BitsStored, 16);
  put(dataset, DCM_HighBit, 15);
  put(dataset, DCM_PixelRepresentation, 0);
  std::vector<Uint16> pixels;
  for (int j = 0; j < image.rows; ++j) {
    for (int i = 0; i < image.columns; ++i) pixels.push_back(static_cast<Uint16>(image.value(i, j)));
  }
  succeed(dataset.putAndInsertUint16Array(DCM_PixelData, pixels.data(), static_cast<unsigned long>(pixels.size())));
  image.edit(dataset);
}

void write(const TestImage& image, const std::filesystem::path& path) {
  DcmFileFormat file;
  fill(*file.getDataset(), image);
  succeed(file.getDataset()->chooseRepresentation(image.syntax, nullptr));
  succeed(file.saveFile(OFFilename(path.c_str()), image.syntax));
}

void write_stack(const std::filesystem::path& folder, int count, const std::function<void(int, TestImage&)>& change) {
  for (int k = 0; k < count; ++k) {
    TestImage image;
    image.z = 2.0 * k;
    image.value = [k](int i, int j) { return 100 * k + 10 * i + j; };
    change(k, image);
    write(image, folder / (numbered("s", k) + ".dcm"));
  }
}

DcmItem& group(DcmItem& item, const DcmTagKey& sequence) {
  DcmItem* made = nullptr;
  succeed(item.findOrCreateSequenceItem(sequence, made, 0));
  return *made;
}

Catalogue find_in(const TestFolder& folder) {
  return find_series(std::array{folder.path()});
}

Series only_series_in(const TestFolder& folder) {
  const Catalogue found = find_in(folder);
  if (found.series.size() == 1) return found.series.front();
  std::string why = std::to_string(found.series.size()) + " series";
  for (const SkippedFile& file : found.skipped) why += "; " + static_cast<const std::string&>(file.reason);
  throw std::runtime_error(why);
}

Volume load_frame(const Series& series, int frame) {
  LoadOptions options;
  options.frame = frame;
  return load(series, options);
}

void make_multi_frame(DcmDataset& dataset, const std::vector<double>& heights,
                      const std::function<void(std::size_t, DcmItem&)>& frame) {
  put(dataset, DCM_SOPClassUID, UID_EnhancedMRImageStorage);
  put(dataset, DCM_Modality, "MR");
  put(dataset, DCM_NumberOfFrames, std::to_string(heights.size()));
  DcmItem& shared = group(dataset, DCM_SharedFunctionalGroupsSequence);
  succeed(
      group(shared, DCM_PlaneOrientationSequence).putAndInsertString(DCM_ImageOrientationPatient, "1\\0\\0\\0\\1\\0"));
  succeed(group(shared, DCM_PixelMeasuresSequence).putAndInsertString(DCM_PixelSpacing, "0.5\\0.75"));
  for (const DcmTagKey& tag : {DCM_ImagePositionPatient, DCM_ImageOrientationPatient, DCM_PixelSpacing}) {
    dataset.findAndDeleteElement(tag);
  }
  for (std::size_t f = 0; f < heights.size(); ++f) {
    DcmItem* item = nullptr;
    succeed(dataset.findOrCreateSequenceItem(DCM_PerFrameFunctionalGroupsSequence, item, -2));
    const std::string position = std::string("0\\0\\") + std::to_string(heights[f]);
    succeed(group(*item, DCM_PlanePositionSequence).putAndInsertString(DCM_ImagePositionPatient, position.c_str()));
    frame(f, *item);
  }
}

void repeat_pixels(DcmDataset& dataset, std::size_t frames) {
  const Uint16* pixels = nullptr;
  unsigned long count = 0;
  succeed(dataset.findAndGetUint16Array(DCM_PixelData, pixels, &count));
  const std::vector<Uint16> one(pixels, pixels + count);
  std::vector<Uint16> all;
  for (std::size_t n = 0; n < frames; ++n) all.insert(all.end(), one.begin(), one.end());
  succeed(dataset.putAndInsertUint16Array(DCM_PixelData, all.data(), static_cast<unsigned long>(all.size())));
}

}  // namespace palpate::io::internal
