// gradient_by_itk COLUMNS ROWS SLICES RUNS: seconds that ITK's GradientRecursiveGaussianImageFilter (1.5 mm, voxels of
// 0.7 x 0.7 x 1 mm) takes for a 16-bit volume of seeded noise, best of some runs on all cores. A yardstick for
// `palpate-bench fields`.
#include <itkGradientRecursiveGaussianImageFilter.h>
#include <itkImage.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  using Image = itk::Image<short, 3>;
  using Gradients = itk::Image<itk::CovariantVector<float, 3>, 3>;
  const auto image = Image::New();
  Image::SizeType size;
  for (unsigned axis = 0; axis < 3; ++axis) size[axis] = static_cast<unsigned>(std::atoi(argv[1 + axis]));
  image->SetRegions(Image::RegionType(size));
  const double spacing[3] = {0.7, 0.7, 1};
  image->SetSpacing(spacing);
  image->Allocate();
  std::minstd_rand random(1);
  short* const voxels = image->GetBufferPointer();
  for (std::size_t n = 0; n < size[0] * size[1] * size[2]; ++n) voxels[n] = static_cast<short>(random() % 2000);
  double best = 1e300;
  for (int run = 0; run < std::atoi(argv[4]); ++run) {
    const auto filter = itk::GradientRecursiveGaussianImageFilter<Image, Gradients>::New();
    filter->SetInput(image);
    filter->SetSigma(1.5);
    const auto start = std::chrono::steady_clock::now();
    filter->Update();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    best = seconds.count() < best ? seconds.count() : best;
  }
  std::printf("%.4f\n", best);
}
