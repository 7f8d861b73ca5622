#include "plugin/paraview/client/views/felt_surfaces.h"

#include <pqRenderView.h>
#include <vtkActor.h>
#include <vtkCellArray.h>
#include <vtkFloatArray.h>
#include <vtkFlyingEdges3D.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPVRenderView.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkPolyDataMapper.h>
#include <vtkProperty.h>
#include <vtkRenderer.h>
#include <vtkSMRenderViewProxy.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <map>
#include <utility>

#include "modes/scene/met_values.h"
#include "plugin/paraview/client/jobs/job.h"
#include "plugin/paraview/client/views/patient_volume.h"
#include "plugin/paraview/client/words/mode_words.h"

namespace palpate::plugin {
namespace {

constexpr double most_voxels = 4e6;
constexpr double surface_least_part = 0.05;  // of a surface's strength: less is not drawn
constexpr int surface_block = 4;             // lattice points across a block whose strength is looked up once

/// Every `step`-th voxel, in indices of the scan.
struct Coarse {
  glm::ivec3 step{1};
  vtkNew<vtkImageData> image;
};

void fill(const io::Volume& volume, Coarse& coarse, const KeepGoing& keep_going) {
  const glm::ivec3& size = volume.geometry.dimensions;
  const double voxels = static_cast<double>(size.x) * size.y * size.z;
  const int step = std::max(1, static_cast<int>(std::ceil(std::cbrt(voxels / most_voxels))));
  const double finest =
      std::min({volume.geometry.spacing_i, volume.geometry.spacing_j, volume.geometry.slice_spacing()});
  const bool thick_slices = volume.geometry.slice_spacing() > 1.5 * finest;
  coarse.step = {step, step, thick_slices ? 1 : step};
  const glm::ivec3 points = (size - 1) / coarse.step + 1;
  coarse.image->SetDimensions(points.x, points.y, points.z);
  coarse.image->AllocateScalars(VTK_FLOAT, 1);
  auto* value = static_cast<float*>(coarse.image->GetScalarPointer());
  for (int k = 0; k < points.z; ++k) {
    check_wanted(keep_going);
    for (int j = 0; j < points.y; ++j) {
      for (int i = 0; i < points.x; ++i) {
        *value++ = static_cast<float>(volume.value_at(i * coarse.step.x, j * coarse.step.y, k * coarse.step.z));
      }
    }
  }
}

/// The strength of a surface, looked up in the middle of each block of the lattice that it crosses.
class BlockStrength {
 public:
  BlockStrength(const modes::Strength& strength, const io::FieldSource& source)
      : strength_(strength), source_(source), known_(contains(source.available(), strength.reads())) {}

  /// Of its most, 0 to 1.
  double part(const glm::vec3& index, const glm::dvec3& place) {
    if (!known_ || strength_.most_n() <= 0) return 1;
    const std::array<int, 3> cell{static_cast<int>(index.x) / surface_block, static_cast<int>(index.y) / surface_block,
                                  static_cast<int>(index.z) / surface_block};
    const auto found = blocks_.find(cell);
    if (found != blocks_.end()) return found->second;
    const io::Sample sample = source_.sample(place, strength_.reads());
    return blocks_[cell] = sample.inside ? strength_(sample) / strength_.most_n() : 0;
  }

 private:
  const modes::Strength& strength_;
  const io::FieldSource& source_;
  bool known_;
  std::map<std::array<int, 3>, double> blocks_;
};

void add_surface(const Coarse& coarse, const io::Geometry& geometry, double value, BlockStrength& strength,
                 FeltSurface& surface, const KeepGoing& keep_going) {
  vtkNew<vtkFlyingEdges3D> edges;
  edges->SetInputData(coarse.image);
  edges->SetValue(0, value);
  edges->ComputeNormalsOff();
  edges->ComputeScalarsOff();
  edges->Update();
  vtkPolyData& found = *edges->GetOutput();
  const auto first = static_cast<int>(surface.points.size());
  std::vector<bool> there;
  for (vtkIdType n = 0; n < found.GetNumberOfPoints(); ++n) {
    check_wanted(keep_going);
    glm::dvec3 at;
    found.GetPoint(n, &at.x);
    const glm::dvec3 place = geometry.to_patient(at * glm::dvec3(coarse.step));
    surface.points.emplace_back(place);
    there.push_back(strength.part(glm::vec3(at), place) > surface_least_part);
  }
  vtkNew<vtkIdList> corners;
  vtkCellArray* const polys = found.GetPolys();
  if (!polys) return;
  polys->InitTraversal();
  while (polys->GetNextCell(corners) != 0) {
    check_wanted(keep_going);
    const std::array<vtkIdType, 3> of{corners->GetId(0), corners->GetId(1), corners->GetId(2)};
    if (!std::ranges::all_of(of, [&](vtkIdType n) { return there[static_cast<std::size_t>(n)]; })) continue;
    surface.triangles.push_back(
        {first + static_cast<int>(of[0]), first + static_cast<int>(of[1]), first + static_cast<int>(of[2])});
  }
}

/// Of each point, the mean of its triangles', by their area.
void add_normals(FeltSurface& surface, const KeepGoing& keep_going) {
  surface.normals.assign(surface.points.size(), glm::vec3(0));
  for (const auto& [a, b, c] : surface.triangles) {
    check_wanted(keep_going);
    const auto at = [&](int n) -> const glm::vec3& { return surface.points[static_cast<std::size_t>(n)]; };
    const glm::vec3 normal = glm::cross(at(b) - at(a), at(c) - at(a));
    for (const int n : {a, b, c}) surface.normals[static_cast<std::size_t>(n)] += normal;
  }
  for (glm::vec3& normal : surface.normals) {
    const float length = glm::length(normal);
    if (length > 0) normal /= length;
  }
}

}  // namespace

std::vector<FeltSurface> felt_surfaces(const io::Volume& volume, const modes::Scene& scene, const modes::Plan& plan,
                                       const io::FieldSource& source, const KeepGoing& keep_going) {
  std::vector<FeltSurface> surfaces;
  double strongest_n = 0;
  for (const modes::ActiveMode& active : plan.modes) {
    if (active.holds) strongest_n = std::max(strongest_n, active.strength.most_n());
  }
  Coarse coarse;
  for (const modes::ActiveMode& active : plan.modes) {
    if (!active.holds || active.scene_index >= scene.modes.size() || strongest_n <= 0) continue;
    const modes::Mode& mode = scene.modes[active.scene_index];
    // Weak ones are seen through; the strongest is still not a wall.
    constexpr double faintest = 0.15, densest = 0.85;
    FeltSurface surface{.mode = active.scene_index,
                        .opacity = faintest + (densest - faintest) * active.strength.most_n() / strongest_n,
                        .points = {},
                        .normals = {},
                        .triangles = {}};
    BlockStrength strength(active.strength, source);
    for (const double value : modes::met_values(mode, active.side)) {
      if (coarse.image->GetNumberOfPoints() == 0) fill(volume, coarse, keep_going);
      add_surface(coarse, volume.geometry, value, strength, surface, keep_going);
    }
    add_normals(surface, keep_going);
    if (!surface.triangles.empty()) surfaces.push_back(std::move(surface));
  }
  return surfaces;
}

struct FeltSurfaces::Felt {
  std::shared_ptr<const io::Volume> volume;
  modes::Scene scene;
  std::shared_ptr<const modes::Plan> plan;
  std::shared_ptr<const io::FieldSource> source;
};

struct FeltSurfaces::One {
  struct Drawn {
    std::shared_ptr<const Felt> felt;
    std::vector<FeltSurface> surfaces;
  };

  explicit One(const ClinicalView& of)
      : view(of.view),
        patient(of.patient),
        renderer(vtkPVRenderView::SafeDownCast(of.view->getRenderViewProxy()->GetClientSideView())->GetRenderer()) {}
  One(const One&) = delete;
  One& operator=(const One&) = delete;
  ~One() { clear(); }

  void clear() {
    for (const auto& actor : actors) renderer->RemoveActor(actor);
    actors.clear();
  }
  /// Surfaces of another scan or frame are not to be seen while this one's are computed. The scan stays hidden.
  void forget() {
    job.cancel();
    clear();
    if (view) view->render();
  }
  void draw(const Drawn& drawn);
  void add(const FeltSurface& surface, const QColor& color);

  QPointer<pqRenderView> view;
  std::weak_ptr<PatientVolume> patient;
  vtkSmartPointer<vtkRenderer> renderer;
  std::vector<vtkSmartPointer<vtkActor>> actors;
  Job job{Job::Newer::follows};  // last: it ends before what it draws
};

void FeltSurfaces::One::add(const FeltSurface& surface, const QColor& color) {
  vtkNew<vtkPoints> points;
  vtkNew<vtkFloatArray> normals;
  vtkNew<vtkCellArray> triangles;
  normals->SetNumberOfComponents(3);
  for (std::size_t n = 0; n < surface.points.size(); ++n) {
    points->InsertNextPoint(surface.points[n].x, surface.points[n].y, surface.points[n].z);
    normals->InsertNextTuple3(surface.normals[n].x, surface.normals[n].y, surface.normals[n].z);
  }
  for (const auto& [a, b, c] : surface.triangles) triangles->InsertNextCell({a, b, c});
  vtkNew<vtkPolyData> shape;
  shape->SetPoints(points);
  shape->GetPointData()->SetNormals(normals);
  shape->SetPolys(triangles);
  vtkNew<vtkPolyDataMapper> mapper;
  mapper->SetInputData(shape);
  mapper->ScalarVisibilityOff();
  const auto actor = vtkSmartPointer<vtkActor>::New();
  actor->SetMapper(mapper);
  actor->PickableOff();
  vtkProperty& look = *actor->GetProperty();
  look.SetColor(color.redF(), color.greenF(), color.blueF());
  look.SetOpacity(surface.opacity);
  look.SetAmbient(0.3);
  look.SetDiffuse(0.7);
  look.SetInterpolationToPhong();
  renderer->AddActor(actor);
  actors.push_back(actor);
}

void FeltSurfaces::One::draw(const Drawn& drawn) {
  clear();
  for (const FeltSurface& surface : drawn.surfaces) add(surface, color_of(drawn.felt->scene.modes[surface.mode]));
  if (const auto shown = patient.lock()) shown->set_hidden(!actors.empty());
  if (view) view->render();
}

FeltSurfaces::FeltSurfaces() = default;
FeltSurfaces::~FeltSurfaces() = default;

void FeltSurfaces::set_views(const std::vector<ClinicalView>& views) {
  one_.reset();
  visible_ = false;
  for (const ClinicalView& view : views) {
    if (view.kind == ViewKind::volume) one_ = std::make_unique<One>(view);
  }
}

void FeltSurfaces::set_visible(bool visible) {
  if (std::exchange(visible_, visible) != visible) draw();
}

void FeltSurfaces::set_felt(const std::shared_ptr<const io::Volume>& volume, const modes::Scene& scene,
                            const std::shared_ptr<const modes::Plan>& plan,
                            const std::shared_ptr<const io::FieldSource>& source) {
  const bool is_other = felt_ && felt_->volume != volume;
  felt_ = volume && plan && source ? std::make_shared<const Felt>(Felt{volume, scene, plan, source}) : nullptr;
  if (!visible_) return;
  if (is_other && one_) one_->forget();
  draw();
}

void FeltSurfaces::draw() {
  if (!one_ || !one_->view) return;
  if (!visible_ || !felt_) {
    one_->job.cancel();
    one_->draw({});
    return;
  }
  one_->job.ask(
      [felt = felt_](const Job::Control& control) -> One::Drawn {
        return {felt, felt_surfaces(*felt->volume, felt->scene, *felt->plan, *felt->source, control.keep_going)};
      },
      [one = one_.get()](const std::shared_ptr<const One::Drawn>& drawn, const QString&) {
        one->draw(drawn ? *drawn : One::Drawn());
      });
}

}  // namespace palpate::plugin
