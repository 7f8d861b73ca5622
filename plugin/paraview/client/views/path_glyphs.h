#pragma once

/// A path through the patient in one view: a line with balls at its ends, in front of everything else.

#include <glm/vec3.hpp>
#include <memory>
#include <vector>

class QColor;
class vtkPVRenderView;

namespace palpate::plugin {

class PathGlyphs {
 public:
  PathGlyphs(vtkPVRenderView& view, const QColor& color);
  PathGlyphs(const PathGlyphs&) = delete;
  PathGlyphs& operator=(const PathGlyphs&) = delete;
  ~PathGlyphs();

  /// mm, patient space; empty hides it. The caller renders the view.
  void show(const std::vector<glm::dvec3>& path);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace palpate::plugin
