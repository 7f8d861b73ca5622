#pragma once

/// The unsaved work that would be lost with another scan, or at the end of the program. Only this class decides what
/// counts as unsaved.

#include <cstddef>
#include <map>
#include <set>
#include <string>
#include <vector>

#include "io/structures/structure.h"
#include "plugin/paraview/client/model/marks_model.h"
#include "plugin/paraview/client/model/scene_model.h"

namespace palpate::plugin {

struct Unsaved {
  bool scene = false;  ///< the felt scene was edited. Reach, limits and stiffness do not count: they concern the hand
  std::vector<std::string> outlines;  ///< corrected outlines, by their names in the scene
  std::size_t marks = 0;              ///< including paths, distances and angles

  bool any() const { return scene || !outlines.empty() || marks > 0; }
};

class UnsavedWork {
 public:
  UnsavedWork(const SceneModel& scene, const MarksModel& marks) : scene_(scene), marks_(marks) {}

  /// Lost with another scan. Marks are not lost: they come back with their scan.
  Unsaved of_scan() const;
  /// Lost at the end of the program.
  Unsaved of_program() const;

  /// A state file contains everything in the pipeline: it was saved or loaded.
  void note_state_saved();
  /// The current scene is saved, in a list or a file.
  void note_scene_saved();
  /// A structure's outline with these edits is saved, in a file or an archive.
  void note_outline_saved(const io::Structure& structure, const std::vector<io::Edit>& edits);
  /// These marks of a scan (as in MarksModel::scan()) are saved in an archive.
  void note_marks_saved(const std::string& scan, const Marks& marks);
  /// The user discards the current scene for another scan: of_scan() is empty until the scene changes.
  void let_scene_go();
  /// The other scan is not opened after all: of_scan() is as before.
  void keep_scene() { scene_let_go_.clear(); }
  /// The same for the scene and all marks: of_program() is empty.
  void let_all_go();
  /// They are still here after all: of_program() is as before.
  void keep_all() { all_let_go_.clear(); }

 private:
  Unsaved all() const;
  std::string text_of_all() const;
  void note_scene_saved(const modes::Scene& scene);
  bool is_outline_saved(const modes::SceneStructure& structure) const;

  const SceneModel& scene_;
  const MarksModel& marks_;
  std::set<std::string> scenes_;                           // saved ones
  std::map<std::string, std::vector<io::Edit>> outlines_;  // saved ones, by structure
  std::set<std::string> items_;                            // saved marks, paths, distances and angles
  std::string scene_let_go_, all_let_go_;
};

}  // namespace palpate::plugin
