// gradient_by_vtk COLUMNS ROWS SLICES RUNS: seconds that vtkImageGradient takes for a 16-bit volume of seeded noise,
// best of some runs on all cores. A yardstick for `palpate-bench fields`.
#include <vtkImageData.h>
#include <vtkImageGradient.h>
#include <vtkSmartPointer.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>

int main(int argc, char** argv) {
  if (argc != 5) return 2;
  const auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(std::atoi(argv[1]), std::atoi(argv[2]), std::atoi(argv[3]));
  image->SetSpacing(0.7, 0.7, 1);
  image->AllocateScalars(VTK_SHORT, 1);
  auto* const voxels = static_cast<short*>(image->GetScalarPointer());
  std::minstd_rand random(1);
  for (vtkIdType n = 0; n < image->GetNumberOfPoints(); ++n) voxels[n] = static_cast<short>(random() % 2000);
  double best = 1e300;
  for (int run = 0; run < std::atoi(argv[4]); ++run) {
    const auto gradient = vtkSmartPointer<vtkImageGradient>::New();
    gradient->SetInputData(image);
    gradient->SetDimensionality(3);
    const auto start = std::chrono::steady_clock::now();
    gradient->Update();
    const std::chrono::duration<double> seconds = std::chrono::steady_clock::now() - start;
    best = seconds.count() < best ? seconds.count() : best;
  }
  std::printf("%.4f\n", best);
}
