// load_by_itk FOLDER: loading with ITK: GDCMSeriesFileNames and ImageSeriesReader, with minimum, maximum and mean. For
// comparison in `palpate-bench load`; only for intact, plain series.
#include <itkGDCMImageIO.h>
#include <itkGDCMSeriesFileNames.h>
#include <itkImage.h>
#include <itkImageSeriesReader.h>

#include <algorithm>
#include <cstdio>

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  using Image = itk::Image<short, 3>;
  const auto names = itk::GDCMSeriesFileNames::New();
  names->SetDirectory(argv[1]);
  const auto reader = itk::ImageSeriesReader<Image>::New();
  reader->SetImageIO(itk::GDCMImageIO::New());
  reader->SetFileNames(names->GetInputFileNames());
  try {
    reader->Update();
  } catch (const itk::ExceptionObject&) {
    return 1;
  }
  const Image& image = *reader->GetOutput();
  const std::size_t count = image.GetBufferedRegion().GetNumberOfPixels();
  const short* const values = image.GetBufferPointer();
  const auto [minimum, maximum] = std::minmax_element(values, values + count);
  double sum = 0;
  for (std::size_t n = 0; n < count; ++n) sum += values[n];
  std::printf("%d slices, %d to %d, mean %.9g\n", static_cast<int>(image.GetBufferedRegion().GetSize(2)), *minimum,
              *maximum, sum / static_cast<double>(count));
}
