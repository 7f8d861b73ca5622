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
  /// Takes a scene over for the stylus, or throws what says why it cannot be felt.
  using Commit = std::function<void(const modes::Scene&, Pace)>;

  explicit SceneModel(QObject* parent = nullptr) : QObject(parent) {}

  /// Asked once for every scene, before anything else has it: what it refuses is refused for panel, pipeline and stylus
  /// alike, and refused() says why. Without one a scene only has to be valid.
  void set_commit(Commit commit) { commit_ = std::move(commit); }

  const modes::Scene& scene() const { return scene_; }
  pqPipelineSource* source() const;

  /// Another scene altogether, in a source of its own on that server where there is none yet.
  void open(pqServer& server, const modes::Scene& scene);
  /// Takes over a scene that stands in the pipeline, as a state file restores it.
  void adopt(pqPipelineSource& source);

  /// A scene that nobody asked for: not a step that can be undone. Whether it was taken.
  bool propose(const modes::Scene& scene);
  /// One step that can be undone; `what` names it in ParaView's menu. A change that is refused leaves the scene as it
  /// was: refused() says why.
  void edit(const QString& what, const Change& change);
  /// A change that goes on, as while a node is dragged: felt at once, and together one step with the finish_drag() that
  /// ends it.
  void drag(const Change& change);
  void finish_drag(const QString& what);

  void undo();
  void redo();
  /// Another scan: what was done to the last one's scene can no longer be undone here.
  void forget_steps();

 signals:
  void changed(palpate::plugin::Pace pace);
  void refused(const QString& why);

 private slots:
  void follow_source();

 private:
  bool take(const modes::Scene& scene, Pace pace);
  void keep(const QString& what);
  void put_back();

  Commit commit_;
  QPointer<pqPipelineSource> source_;
  modes::Scene scene_;
  std::string text_;  // of the scene as the source has it
  bool keeping_ = false;
};

}  // namespace palpate::plugin
