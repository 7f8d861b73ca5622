#pragma once

/// Presses that make a structure felt. Each reads first what its scene needs, in the background: neither panel nor
/// servo waits for it. A press belongs to what was chosen when it was pressed, and all of them are done, in their
/// order.

#include <QString>

#include <deque>
#include <functional>

#include "modes/scene/scene.h"
#include "plugin/paraview/client/model/scene_model.h"

namespace palpate::plugin {

class StructurePresses {
 public:
  /// Reads what an edited scene needs, and calls `done` on the thread that asked; with an error if it cannot be read.
  using Read = std::function<void(const modes::Scene& edited, std::function<void(const QString& error)> done)>;
  /// Gets what a press comes to: `note` where it was done, else why it was not.
  using Told = std::function<void(const QString& text, bool problem)>;

  StructurePresses(SceneModel& model, Read read, Told told);
  StructurePresses(const StructurePresses&) = delete;
  StructurePresses& operator=(const StructurePresses&) = delete;

  /// `what` names the step in ParaView's menu. `note` is what a user should know of the structure.
  void press(const QString& what, SceneModel::Change edit, const QString& note);
  /// Another scan: what was pressed for the one before is not done.
  void drop();
  bool is_busy() const { return !waiting_.empty(); }

 private:
  struct Press {
    QString what;
    SceneModel::Change edit;
    QString note;
  };
  void begin();
  void finish(const QString& error);

  SceneModel& model_;
  Read read_;
  Told told_;
  std::deque<Press> waiting_;  // the first of them is being read for
  unsigned run_ = 0;           // an answer to another is ignored
};

}  // namespace palpate::plugin
