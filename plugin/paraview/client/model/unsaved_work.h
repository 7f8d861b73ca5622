#pragma once

/// What would be lost with another scan, or at the end of the program: the one place that decides what is not saved.

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
  bool scene = false;                 ///< what is felt was edited. Reach, limits and stiffness are the hand's
  std::vector<std::string> outlines;  ///< that were corrected, by their names in the scene
  std::size_t marks = 0;              ///< with paths, distances and angles

  bool any() const { return scene || !outlines.empty() || marks > 0; }
};

class UnsavedWork {
 public:
  UnsavedWork(const SceneModel& scene, const MarksModel& marks) : scene_(scene), marks_(marks) {}

  /// Another scan would take it away. Marks wait until their scan comes back.
  Unsaved of_scan() const;
  /// The end of the program would.
  Unsaved of_program() const;

  /// A state file has all that the pipeline has, or has brought it.
  void note_state_saved();
  /// The scene as it is can be had again: it stands in a list or in a file.
  void note_scene_saved();
  /// A structure's outline with these edits is in a file or in an archive.
  void note_outline_saved(const io::Structure& structure, const std::vector<io::Edit>& edits);
  /// These marks of a scan, as MarksModel::scan() names it, are in an archive.
  void note_marks_saved(const std::string& scan, const Marks& marks);
  /// The user does not want the scene as it is: of_scan() is empty until it is another one.
  void let_scene_go();
  /// The same of the scene and of all marks: of_program() is empty.
  void let_all_go();

 private:
  Unsaved all() const;
  std::string text_of_all() const;
  void note_scene_saved(const modes::Scene& scene);
  bool is_outline_saved(const modes::SceneStructure& structure) const;

  const SceneModel& scene_;
  const MarksModel& marks_;
  std::set<std::string> scenes_;                           // that are saved
  std::map<std::string, std::vector<io::Edit>> outlines_;  // the same, by structure
  std::set<std::string> items_;                            // marks, paths, distances and angles that are saved
  std::string scene_let_go_, all_let_go_;
};

}  // namespace palpate::plugin
