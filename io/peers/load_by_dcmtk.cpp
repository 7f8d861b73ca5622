// load_by_dcmtk FOLDER: loading with DCMTK alone, one file after the other: decode, sort by position, rescale, minimum,
// maximum and mean. For comparison in `palpate-bench load`; only for intact, plain series.
#include <dcmtk/config/osconfig.h>
#include <dcmtk/dcmdata/dcdeftag.h>
#include <dcmtk/dcmdata/dcfilefo.h>
#include <dcmtk/dcmjpeg/djdecode.h>
#include <dcmtk/oflog/oflog.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <map>
#include <vector>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  OFLog::configure(OFLogger::OFF_LOG_LEVEL);
  DJDecoderRegistration::registerCodecs();
  std::map<double, std::vector<Uint16>> slices;
  double minimum = 1e300;
  double maximum = -1e300;
  double sum = 0;
  double count = 0;
  for (const auto& entry : std::filesystem::directory_iterator(argv[1])) {
    DcmFileFormat file;
    if (file.loadFile(OFFilename(entry.path().c_str())).bad()) continue;
    DcmDataset& dataset = *file.getDataset();
    if (dataset.chooseRepresentation(EXS_LittleEndianExplicit, nullptr).bad()) continue;
    const Uint16* pixels = nullptr;
    unsigned long length = 0;
    Float64 z = 0;
    Float64 slope = 1;
    Float64 intercept = 0;
    Uint16 is_signed = 0;
    if (dataset.findAndGetUint16Array(DCM_PixelData, pixels, &length).bad()) continue;
    dataset.findAndGetFloat64(DCM_ImagePositionPatient, z, 2);
    if (dataset.findAndGetFloat64(DCM_RescaleSlope, slope).bad()) slope = 1;
    dataset.findAndGetFloat64(DCM_RescaleIntercept, intercept);
    dataset.findAndGetUint16(DCM_PixelRepresentation, is_signed);
    const auto& slice = slices[z] = std::vector<Uint16>(pixels, pixels + length);
    for (const Uint16 stored : slice) {
      const double value = slope * (is_signed != 0 ? static_cast<Sint16>(stored) : stored) + intercept;
      minimum = std::min(minimum, value);
      maximum = std::max(maximum, value);
      sum += value;
    }
    count += static_cast<double>(length);
  }
  std::printf("%zu slices, %g to %g, mean %.9g\n", slices.size(), minimum, maximum, sum / count);
}
