#pragma once

/// The scene that the panel edits. It stands in ParaView's pipeline as a source (PalpateScene), so that ParaView's
/// undo, state files and traces hold every edit.

#include <pqPipelineSource.h>

#include <QObject>
#include <QPointer>

#include <functional>
#include <string>
#include <utility>

#include "modes/scene/scene.h"
#include "plugin/app/live_session.h"

class pqServer;

namespace palpate::plugin {

class SceneModel : public QObject {
  Q_OBJECT

 public:
  using Change = std::function<void(modes::Scene&)>;
  /// Lets the stylus take a scene over, or throws with the reason why it cannot be felt.
  using Commit = std::function<void(const modes::Scene&, Pace)>;

  explicit SceneModel(QObject* parent = nullptr) : QObject(parent) {}

  /// Called once for every scene, before anything else gets it. A scene that it refuses is refused for panel, pipeline
  /// and stylus alike, and refused() gives the reason. Without it a scene only has to be valid.
  void set_commit(Commit commit) { commit_ = std::move(commit); }

  /// Prepares in the background what takes long for a scene: it then returns true, and calls `ready` once. False: there
  /// is nothing to wait for.
  using MakeReady = std::function<bool(const modes::Scene& scene, std::function<void()> ready)>;
  /// Called for a scene that comes from the pipeline (undo, a trace, the property panel). Until it is ready the
  /// previous scene stays. If another scene comes meanwhile, it takes its place.
  void set_make_ready(MakeReady make_ready) { make_ready_ = std::move(make_ready); }
  /// The pipeline holds a scene that was refused: sets it back to the scene that is felt.
  void put_back();

  const modes::Scene& scene() const { return scene_; }
  pqPipelineSource* source() const;

  /// A completely different scene. Makes a source on that server if there is none yet.
  void open(pqServer& server, const modes::Scene& scene);
  /// Takes over a scene that stands in the pipeline, as a state file restores it.
  void adopt(pqPipelineSource& source);

  /// A scene that the panel proposes by itself: it is not a step that can be undone. Returns whether it was accepted.
  bool propose(const modes::Scene& scene);
  /// One step that can be undone; `what` names it in ParaView's menu. A change that is refused leaves the scene as it
  /// was: refused() says why.
  void edit(const QString& what, const Change& change);
  /// A change in progress, such as dragging a node. It is felt at once. Together with the finish_drag() that ends it,
  /// it is one step.
  void drag(const Change& change);
  void finish_drag(const QString& what);

  bool can_undo() const;
  void undo();
  void redo();
  /// Another scan: edits of the previous one's scene can no longer be undone here.
  void forget_steps();

 signals:
  /// The scene is in another source from now on.
  void sourced(pqPipelineSource& source);
  void changed(palpate::plugin::Pace pace);
  void refused(const QString& why);

 private slots:
  void follow_source();

 private:
  bool take(const modes::Scene& scene, Pace pace);
  void keep(const QString& what);
  void take_text(const std::string& text, bool when_ready);

  Commit commit_;
  MakeReady make_ready_;
  QPointer<pqPipelineSource> source_;
  modes::Scene scene_;
  std::string text_;  // of the scene as the source has it
  bool keeping_ = false;
};

}  // namespace palpate::plugin
