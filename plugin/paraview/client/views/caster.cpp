#include "plugin/paraview/client/views/caster.h"

#include <vtkCamera.h>
#include <vtkDirectionEncoder.h>
#include <vtkEncodedGradientEstimator.h>
#include <vtkEncodedGradientShader.h>
#include <vtkFiniteDifferenceGradientEstimator.h>
#include <vtkFixedPointRayCastImage.h>
#include <vtkImageData.h>
#include <vtkLight.h>
#include <vtkLightCollection.h>
#include <vtkMatrix4x4.h>
#include <vtkObjectFactory.h>
#include <vtkPlaneCollection.h>
#include <vtkRenderer.h>
#include <vtkSmartPointer.h>
#include <vtkVolume.h>
#include <vtkVolumeCollection.h>
#include <vtkVolumeProperty.h>

#include <QElapsedTimer>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <utility>

#include "plugin/paraview/client/views/octahedron_directions.h"

namespace palpate::plugin {
namespace {

constexpr double turn_s = 0.014;  // less than a frame at 30 Hz
constexpr int rows_at_once = 8;

/// The same in a fraction of the time that VTK's own takes, which computes angles.
class Directions : public vtkDirectionEncoder {
 public:
  static Directions* New() { VTK_STANDARD_NEW_BODY(Directions); }

  int GetEncodedDirection(float n[3]) override { return code_of(n); }
  float* GetDecodedGradient(int value) override { return table_.data() + 3 * static_cast<std::ptrdiff_t>(value); }
  int GetNumberOfEncodedDirections() override { return lit_ ? 0 : direction_codes; }
  float* GetDecodedGradientTable() override { return table_.data(); }
  /// True: the directions are lit already, and are not lit again.
  void set_lit(bool lit) { lit_ = lit; }

 private:
  bool lit_ = false;
  std::vector<float> table_ = decoded_directions();
};

/// All that the light on a volume depends on, besides the directions of its gradients.
std::vector<double> light_on(vtkRenderer& renderer, vtkVolume& volume) {
  std::vector<double> all{static_cast<double>(volume.GetProperty()->GetMTime())};
  const auto add = [&](const double* numbers, int count) { all.insert(all.end(), numbers, numbers + count); };
  add(volume.GetMatrix()->GetData(), 16);
  add(renderer.GetActiveCamera()->GetPosition(), 3);
  add(renderer.GetActiveCamera()->GetFocalPoint(), 3);
  all.push_back(renderer.GetTwoSidedLighting());
  vtkLightCollection& lights = *renderer.GetLights();
  for (int n = 0; n < lights.GetNumberOfItems(); ++n) {
    auto& light = *vtkLight::SafeDownCast(lights.GetItemAsObject(n));
    std::array<double, 3> at, to;
    light.GetTransformedPosition(at.data());
    light.GetTransformedFocalPoint(to.data());
    add(at.data(), 3);
    add(to.data(), 3);
    add(light.GetAmbientColor(), 3);
    add(light.GetDiffuseColor(), 3);
    add(light.GetSpecularColor(), 3);
    all.push_back(light.GetSwitch() != 0 ? light.GetIntensity() : 0);
  }
  return all;
}

/// Everything that a picture depends on, except objects drawn in front of the volume.
std::vector<double> sight_of(vtkRenderer& renderer, vtkVolume& volume, Caster& caster) {
  std::vector<double> all = light_on(renderer, volume);
  vtkCamera& camera = *renderer.GetActiveCamera();
  const double* const matrix = camera.GetViewTransformMatrix()->GetData();
  all.insert(all.end(), matrix, matrix + 16);
  all.push_back(camera.GetParallelProjection());
  all.push_back(camera.GetParallelProjection() != 0 ? camera.GetParallelScale() : camera.GetViewAngle());
  all.push_back(renderer.GetSize()[0]);
  all.push_back(renderer.GetSize()[1]);
  all.push_back(static_cast<double>(caster.GetInput()->GetMTime()));
  vtkPlaneCollection* const planes = caster.GetClippingPlanes();
  all.push_back(planes ? static_cast<double>(planes->GetMTime()) : 0);
  for (int n = 0; planes && n < planes->GetNumberOfItems(); ++n) {
    all.push_back(static_cast<double>(planes->GetItem(n)->GetMTime()));
  }
  return all;
}

}  // namespace

/// The latest picture: four numbers for each pixel.
struct Caster::Picture {
  std::vector<std::uint16_t> pixels;
  int memory_width = 0;
  std::array<int, 2> origin{}, size{};
  double distance = 1;  ///< between its pixels, in those of the view
};

vtkStandardNewMacro(Caster);

Caster::Caster() {
  DirectionEncoder->Delete();
  DirectionEncoder = Directions::New();
  GradientEstimator->SetDirectionEncoder(DirectionEncoder);
  // A sample is lit with the eight voxels around it. Beside the skin some of them have no gradient, and VTK ignores
  // these.
  constexpr float where_flat = 0.5F;
  GradientShader->SetZeroNormalDiffuseIntensity(where_flat);
}

/// While a stylus moves nothing else does: the light stays.
void Caster::Render(vtkRenderer* renderer, vtkVolume* volume) {
  std::vector<double> light = light_on(*renderer, *volume);
  auto& directions = static_cast<Directions&>(*DirectionEncoder);
  directions.set_lit(light == light_);
  if (in_turns_ && RayCastImage->GetImage()) {
    render_turn(*renderer, *volume);
  } else {
    leave_unfinished();
    vtkFixedPointVolumeRayCastMapper::Render(renderer, volume);
  }
  directions.set_lit(false);
  light_ = std::move(light);
}

void Caster::set_in_turns(bool in_turns) {
  in_turns_ = in_turns;
  if (in_turns) turned_ = false;
}

/// What VTK's Render does, with pauses between the rows, in which others have their turn.
void Caster::render_turn(vtkRenderer& renderer, vtkVolume& volume) {
  std::vector<double> sight = sight_of(renderer, volume, *this);
  turned_ = true;
  if (bounds_.empty() || sight != sight_) {
    leave_unfinished();
    begin(renderer, volume);
    sight_ = std::move(sight);
  }
  DisplayRenderedImage(&renderer, &volume);
  if (has_rows_left()) return;
  // Of this time VTK's next coarse picture is as coarse as it has to be.
  StoreRenderTime(&renderer, &volume, static_cast<float>(cast_s_) * ImageSampleDistance * ImageSampleDistance);
  SampleDistance = OldSampleDistance;
  bounds_.clear();
}

void Caster::begin(vtkRenderer& renderer, vtkVolume& volume) {
  const Picture coarse = picture();
  std::array<double, 3> unused_vector{};
  std::array<int, 6> unused_extent{};
  PerImageInitialization(&renderer, &volume, 0, unused_vector.data(), unused_vector.data(), unused_extent.data());
  PerVolumeInitialization(&renderer, &volume);
  PerSubVolumeInitialization(&renderer, &volume, 0);
  bounds_.assign(RowBounds, RowBounds + 2 * static_cast<std::ptrdiff_t>(RayCastImage->GetImageInUseSize()[1]));
  next_row_ = 0;
  cast_s_ = 0;
  enlarge(coarse);
}

Caster::Picture Caster::picture() const {
  Picture now;
  RayCastImage->GetImageOrigin(now.origin.data());
  RayCastImage->GetImageInUseSize(now.size.data());
  now.memory_width = RayCastImage->GetImageMemorySize()[0];
  now.distance = RayCastImage->GetImageSampleDistance();
  const std::uint16_t* const first = RayCastImage->GetImage();
  now.pixels.assign(first, first + 4 * static_cast<std::ptrdiff_t>(now.memory_width) * now.size[1]);
  return now;
}

/// Fills the rows still to be cast from a coarse picture.
void Caster::enlarge(const Picture& coarse) {
  const int* const origin = RayCastImage->GetImageOrigin();
  const double ratio = RayCastImage->GetImageSampleDistance() / coarse.distance;
  const auto from = [&](int axis, int pixel) {
    return static_cast<int>((origin[axis] + pixel + 0.5) * ratio) - coarse.origin[static_cast<std::size_t>(axis)];
  };
  for (int row = 0; 2 * static_cast<std::size_t>(row) < bounds_.size(); ++row) {
    const int coarse_row = from(1, row);
    if (coarse_row < 0 || coarse_row >= coarse.size[1]) continue;
    const int first = bounds_[2 * static_cast<std::size_t>(row)], last = bounds_[2 * static_cast<std::size_t>(row) + 1];
    std::uint16_t* const pixels =
        RayCastImage->GetImage() + 4 * static_cast<std::ptrdiff_t>(row) * RayCastImage->GetImageMemorySize()[0];
    for (int column = first; column <= last; ++column) {
      const int coarse_column = from(0, column);
      if (coarse_column < 0 || coarse_column >= coarse.size[0]) continue;
      const auto at = 4 * (static_cast<std::ptrdiff_t>(coarse_row) * coarse.memory_width + coarse_column);
      std::copy_n(coarse.pixels.begin() + at, 4, pixels + 4 * static_cast<std::ptrdiff_t>(column));
    }
  }
}

/// VTK casts the rays between a row's bounds: the other rows are left without any meanwhile.
bool Caster::cast_rows() {
  QElapsedTimer clock;
  clock.start();
  const auto seconds = [&] { return 1e-9 * static_cast<double>(clock.nsecsElapsed()); };
  const int rows = static_cast<int>(bounds_.size() / 2);
  const auto leave_out = [](int* begin, const int* end) {
    for (; begin != end; begin += 2) {
      begin[0] = 1;
      begin[1] = 0;
    }
  };
  leave_out(RowBounds, RowBounds + bounds_.size());
  while (next_row_ < rows && seconds() < turn_s) {
    const int first = 2 * next_row_, last = 2 * std::min(next_row_ + rows_at_once, rows);
    std::copy(bounds_.begin() + first, bounds_.begin() + last, RowBounds + first);
    RenderSubVolume();
    leave_out(RowBounds + first, RowBounds + last);
    next_row_ = last / 2;
  }
  std::copy(bounds_.begin(), bounds_.end(), RowBounds);  // by which VTK clears its next picture
  cast_s_ += seconds();
  return !has_rows_left();
}

void Caster::leave_unfinished() {
  if (!bounds_.empty()) AbortRender();  // the coarse picture's distances are those that VTK's time belongs to
  bounds_.clear();
}

bool draw_in_turns(vtkRenderer& renderer, const std::function<void()>& draw) {
  std::vector<vtkSmartPointer<Caster>> casters;
  vtkVolumeCollection& volumes = *renderer.GetVolumes();
  for (int n = 0; n < volumes.GetNumberOfItems(); ++n) {
    auto* const volume = vtkVolume::SafeDownCast(volumes.GetItemAsObject(n));
    if (auto* const caster = dynamic_cast<Caster*>(volume->GetMapper())) casters.emplace_back(caster);
  }
  bool has_rows_left = false;
  for (const auto& one : casters) {
    if (one->has_rows_left() && !one->cast_rows()) has_rows_left = true;
  }
  if (has_rows_left) return false;
  for (const auto& one : casters) one->set_in_turns(true);
  draw();
  for (const auto& one : casters) one->set_in_turns(false);
  return std::ranges::all_of(casters, [](const auto& one) { return one->is_whole(); });
}

}  // namespace palpate::plugin
