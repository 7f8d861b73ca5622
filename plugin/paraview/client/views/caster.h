#pragma once

/// VTK's ray caster for processors, with a light that is not computed anew where nothing changed, and with pictures
/// that can be cast in turns, so that the thread that paints is never long busy with one.

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

  /// While on, Render casts nothing: it shows the picture before, however coarse, until cast_rows() has cast all rows
  /// and Render is called again. A change of what is seen begins anew.
  void set_in_turns(bool in_turns);
  bool has_rows_left() const { return 2 * static_cast<std::size_t>(next_row_) < bounds_.size(); }
  /// As many as it can in some milliseconds, from the lowest up. Returns whether none is left.
  bool cast_rows();
  /// Whether the picture that Render was asked for in turns is drawn in full.
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
  double cast_s_ = 0;  ///< how long its rows have taken
};

/// To be called again and again until it returns true: the renderer's volumes are drawn in full then. Each time it
/// casts for some milliseconds, and calls `draw`, which renders, at the beginning and at the end alone.
bool draw_in_turns(vtkRenderer& renderer, const std::function<void()>& draw);

}  // namespace palpate::plugin
