// load_by_gdcm FOLDER: loading with GDCM: Directory, IPPSorter and ImageReader, one file after the other, with minimum,
// maximum and mean. For comparison in `palpate-bench load`; only for intact, plain series.
#include <gdcmDirectory.h>
#include <gdcmIPPSorter.h>
#include <gdcmImageReader.h>
#include <gdcmTrace.h>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <vector>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  gdcm::Trace::SetWarning(false);
  gdcm::Directory directory;
  directory.Load(argv[1]);
  gdcm::IPPSorter sorter;
  sorter.SetComputeZSpacing(false);
  if (!sorter.Sort(directory.GetFilenames())) return 1;
  std::vector<std::vector<char>> slices;
  double minimum = 1e300;
  double maximum = -1e300;
  double sum = 0;
  double count = 0;
  for (const auto& name : sorter.GetFilenames()) {
    gdcm::ImageReader reader;
    reader.SetFileName(name.c_str());
    if (!reader.Read()) return 1;
    const gdcm::Image& image = reader.GetImage();
    auto& slice = slices.emplace_back(image.GetBufferLength());
    if (!image.GetBuffer(slice.data())) return 1;
    const auto add = [&](auto* pixels) {
      const std::size_t length = slice.size() / 2;
      for (std::size_t i = 0; i < length; ++i) {
        const double value = image.GetSlope() * pixels[i] + image.GetIntercept();
        minimum = std::min(minimum, value);
        maximum = std::max(maximum, value);
        sum += value;
      }
      count += static_cast<double>(length);
    };
    if (image.GetPixelFormat().GetPixelRepresentation() != 0) {
      add(reinterpret_cast<const std::int16_t*>(slice.data()));
    } else {
      add(reinterpret_cast<const std::uint16_t*>(slice.data()));
    }
  }
  std::printf("%zu slices, %g to %g, mean %.9g\n", slices.size(), minimum, maximum, sum / count);
}
