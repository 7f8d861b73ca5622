#include "plugin/paraview/client/views/felt_contours.h"

#include <vtkCellArray.h>
#include <vtkFlyingEdges2D.h>
#include <vtkIdList.h>
#include <vtkImageData.h>
#include <vtkNew.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkSmartPointer.h>

#include <algorithm>
#include <cmath>
#include <glm/vec2.hpp>
#include <limits>
#include <map>
#include <utility>

#include "modes/scene/met_values.h"

namespace palpate::plugin {
namespace {

constexpr double least_part = 0.05;  // of a surface's strength: less is not drawn
constexpr int block = 4;             // points across a block whose strength is looked up once

vtkSmartPointer<vtkImageData> values_on(const io::FieldSource& source, const SlicePoints& points,
                                        const KeepGoing& keep_going) {
  auto image = vtkSmartPointer<vtkImageData>::New();
  image->SetDimensions(points.columns, points.rows, 1);
  image->AllocateScalars(VTK_DOUBLE, 1);
  auto* value = static_cast<double*>(image->GetScalarPointer());
  for (int row = 0; row < points.rows; ++row) {
    check_wanted(keep_going);
    for (int column = 0; column < points.columns; ++column) {
      const glm::dvec3 at =
          points.corner + static_cast<double>(column) * points.right + static_cast<double>(row) * points.up;
      const io::Sample sample = source.sample(at, io::FieldSet::value);
      *value++ = sample.inside ? sample.value : std::numeric_limits<double>::quiet_NaN();
    }
  }
  return image;
}

/// Whether a surface has strength, looked up in the middle of each block of points that a line crosses.
class StrengthMask {
 public:
  StrengthMask(const modes::Strength& strength, const io::FieldSource& source, double factor)
      : strength_(strength), source_(source), least_(least_part * factor * strength.most_n()) {
    known_ = contains(source.available(), strength.reads());
  }

  bool holds(const glm::dvec2& point, const glm::dvec3& place) {
    if (!known_) return true;
    const std::pair<int, int> cell{static_cast<int>(point.x) / block, static_cast<int>(point.y) / block};
    const auto found = blocks_.find(cell);
    if (found != blocks_.end()) return found->second;
    const io::Sample sample = source_.sample(place, strength_.reads());
    return blocks_[cell] = sample.inside && strength_(sample) > least_;
  }

 private:
  const modes::Strength& strength_;
  const io::FieldSource& source_;
  double least_;
  bool known_ = true;
  std::map<std::pair<int, int>, bool> blocks_;
};

void add_pieces(vtkImageData& image, double value, const SlicePoints& points, StrengthMask& mask, FeltContour& contour,
                const KeepGoing& keep_going) {
  vtkNew<vtkFlyingEdges2D> lines;
  lines->SetInputData(&image);
  lines->SetValue(0, value);
  lines->Update();
  vtkPolyData& found = *lines->GetOutput();
  if (!found.GetLines()) return;
  vtkNew<vtkIdList> ends;
  found.GetLines()->InitTraversal();
  while (found.GetLines()->GetNextCell(ends) != 0) {
    check_wanted(keep_going);
    for (vtkIdType n = 1; n < ends->GetNumberOfIds(); ++n) {
      std::array<glm::dvec3, 2> piece{};
      glm::dvec3 at[2];
      for (int end = 0; end < 2; ++end) {
        found.GetPoint(ends->GetId(n - 1 + end), &at[end].x);
        piece[static_cast<std::size_t>(end)] = points.corner + at[end].x * points.right + at[end].y * points.up;
      }
      const glm::dvec3 middle = 0.5 * (piece[0] + piece[1]);
      if (std::isfinite(middle.x) && mask.holds(0.5 * (at[0] + at[1]), middle)) contour.pieces.push_back(piece);
    }
  }
}

}  // namespace

std::vector<FeltContour> felt_contours(const modes::Scene& scene, const modes::Plan& plan,
                                       const io::FieldSource& source, const SlicePoints& points,
                                       const KeepGoing& keep_going) {
  std::vector<FeltContour> contours;
  if (points.columns < 2 || points.rows < 2 || !contains(source.available(), io::FieldSet::value)) return contours;
  vtkSmartPointer<vtkImageData> image;
  for (const modes::ActiveMode& active : plan.modes) {
    if (!active.holds || active.scene_index >= scene.modes.size()) continue;
    const modes::Mode& mode = scene.modes[active.scene_index];
    FeltContour contour{.mode = active.scene_index};
    for (const double value : modes::met_values(mode, active.side)) {
      if (!image) image = values_on(source, points, keep_going);
      StrengthMask mask(active.strength, source, modes::value_factor(mode, value));
      add_pieces(*image, value, points, mask, contour, keep_going);
    }
    if (!contour.pieces.empty()) contours.push_back(std::move(contour));
  }
  return contours;
}

}  // namespace palpate::plugin
