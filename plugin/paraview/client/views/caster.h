#pragma once

/// VTK's software ray caster with two additions: it does not recompute shading if nothing has changed, and it can cast
/// a picture in turns, so that the UI thread is never busy with it for long.

#include <vtkFixedPointVolumeRayCastMapper.h>

#include <cstddef>
#include <functional>
#include <vector>

namespace palpate::plugin {

class Caster : public vtkFixedPointVolumeRayCastMapper {
 public:
  static Caster* New();
  const char* GetClassNameInternal() const override { return "Caster"; }

  void Render(vtkRenderer* renderer, vtkVolume* volume) override;

  /// While on, Render casts nothing: it shows the previous, perhaps coarse picture until cast_rows() has cast all rows
  /// and Render is called again. A change of the picture starts again.
  void set_in_turns(bool in_turns);
  bool has_rows_left() const { return 2 * static_cast<std::size_t>(next_row_) < bounds_.size(); }
  /// Casts rows for some milliseconds, from the lowest up. Returns whether none is left.
  bool cast_rows();
  /// Whether the picture requested by Render in turns is complete.
  bool is_whole() const { return !turned_ || bounds_.empty(); }

 protected:
  Caster();

 private:
  struct Picture;
  Picture picture() const;
  void enlarge(const Picture& coarse);
  void begin(vtkRenderer& renderer, vtkVolume& volume);
  void render_turn(vtkRenderer& renderer, vtkVolume& volume);
  void leave_unfinished();

  std::vector<double> light_, sight_;
  bool in_turns_ = false, turned_ = false;
  std::vector<int> bounds_;  ///< of a picture that is cast in turns: the first and last pixel of each row; else empty
  int next_row_ = 0;
  double cast_s_ = 0;  ///< time taken by its rows
};

/// To be called until it returns true: then the renderer's volumes are completely drawn. Each call casts for some
/// milliseconds; `draw`, which renders, is called only in the first and the last one.
bool draw_in_turns(vtkRenderer& renderer, const std::function<void()>& draw);

}  // namespace palpate::plugin
