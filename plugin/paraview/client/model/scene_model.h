#pragma once

/// Owns the scene that the panel edits. ParaView's pipeline keeps its text, so that ParaView's undo, state files and
/// traces hold every edit. A change for which files have to be read first is done when they are: it and those that come
/// meanwhile wait, and are done in their order.

#include <QObject>
#include <QString>

#include <deque>
#include <functional>
#include <optional>
#include <string>
#include <utility>

#include "modes/scene/scene.h"
#include "plugin/app/live_session.h"
#include "plugin/paraview/client/model/kept_text.h"

namespace palpate::plugin {

class SceneModel : public QObject {
  Q_OBJECT

 public:
  /// It may be done after others, and more than once: it holds what it needs.
  using Change = std::function<void(modes::Scene&)>;
  /// Lets the stylus take a scene over, or throws with the reason why it cannot be felt.
  using Commit = std::function<void(const modes::Scene&, Pace)>;
  /// Gets the reason why a change was refused, or an empty one where it was accepted.
  using Told = std::function<void(const QString& why)>;

  explicit SceneModel(KeptText& kept, QObject* parent = nullptr);

  /// Called once for every scene, before anything else gets it. A scene that it refuses is refused for panel, pipeline
  /// and stylus alike. Without it a scene only has to be valid.
  void set_commit(Commit commit) { commit_ = std::move(commit); }

  /// Prepares in the background what takes long for a scene: it then returns true, and calls `ready` once. False: there
  /// is nothing to wait for.
  using MakeReady = std::function<bool(const modes::Scene& scene, std::function<void()> ready)>;
  /// Called for a scene that comes from the pipeline (undo, a trace, the property panel). Until it is ready the
  /// previous scene stays. If another scene comes meanwhile, it takes its place.
  void set_make_ready(MakeReady make_ready) { make_ready_ = std::move(make_ready); }
  /// The same for every change, whoever makes it: reads what the scene needs. `done` gets an error if that cannot be
  /// read; the change is then refused. Asked again when `done` was called, because the scan may be another by then.
  using Read = std::function<bool(const modes::Scene& scene, std::function<void(const QString& error)> done)>;
  void set_read(Read read) { read_ = std::move(read); }
  /// Whether a change waits.
  bool is_waiting() const { return reading_ || !waiting_.empty(); }
  /// Another scan: the changes that wait were meant for the one before, and are not done. The pipeline's scene is.
  void drop_waiting();
  /// Takes out of a scene that comes from the pipeline what does not belong there, and returns whether there was any:
  /// the pipeline gets it without.
  void set_clean(std::function<bool(modes::Scene&)> clean) { clean_ = std::move(clean); }
  /// The pipeline holds a scene that was refused: sets it back to the scene that is felt.
  void put_back();

  const modes::Scene& scene() const { return scene_; }
  /// The one that was opened or proposed last, before it was edited.
  const modes::Scene& opened() const { return opened_; }
  /// As the pipeline keeps it, and with it a state file; none: it keeps none, or what is no scene.
  std::optional<modes::Scene> kept() const;
  /// Whether the scene is no longer the one that was opened or proposed.
  bool is_edited() const { return edited_; }

  /// A completely different scene. Makes a place in the pipeline if there is none yet.
  void open(const modes::Scene& scene);
  /// A scene that the panel proposes by itself: it is not a step that can be undone. Returns whether it was accepted.
  bool propose(const modes::Scene& scene);
  /// One step that can be undone; `what` names it in ParaView's menu. A change that is refused leaves the scene as it
  /// was. The reason goes to `told`, which shows it beside what was pressed; without it, refused() gives it. A change
  /// is made of the scene as it is when it is done: those before it are part of it.
  void edit(const QString& what, const Change& change, const Told& told = {});
  /// The same of one mode, if the scene still has it when the change is done.
  void edit_mode(const QString& what, std::size_t mode, std::function<void(modes::Mode&)> change,
                 const Told& told = {});
  /// A change in progress, such as dragging a node. It is felt at once; of those that wait only the newest is done.
  /// Together with the finish_drag() that ends it, it is one step.
  void drag(const Change& change, const Told& told = {});
  void finish_drag(const QString& what);
  /// A change that is no step by itself: felt with a step's ramp, and kept with the next step, or by finish_drag().
  void pass(const Change& change, const Told& told = {});

  bool can_undo() const { return kept_.can_undo(); }
  void undo() { kept_.undo(); }
  void redo() { kept_.redo(); }
  /// Another scan: edits of the previous one's scene can no longer be undone here.
  void forget_steps() { kept_.forget_steps(); }

 signals:
  void changed(palpate::plugin::Pace pace);
  /// A scene was refused that no button asked for: it is the pipeline's, or a file's.
  void refused(const QString& why);

 private:
  struct Step {
    enum class Kind { edit, drag, pass, finish, text };
    Kind kind = Kind::edit;
    QString what;
    Change change;
    Told told;
    std::string text;  ///< the pipeline's; one that came later has taken its place there
  };
  void follow_text();
  void make_ready(const std::string& text);
  void put(Step step);
  void run(const Step& step);
  void run_text(const Step& step);
  bool waits_for(const modes::Scene& scene, const Step& step);
  void finish_reading(const QString& error);
  void go_on();
  /// Why it was refused; empty: it was not.
  QString take(const modes::Scene& scene, Pace pace);
  void tell(const QString& why, const Told& told);
  void refuse_text(const QString& why);
  void keep(const QString& what);

  KeptText& kept_;
  Commit commit_;
  MakeReady make_ready_;
  Read read_;
  std::function<bool(modes::Scene&)> clean_;
  modes::Scene scene_, opened_;
  std::string text_;  // of the scene as the pipeline has it
  bool edited_ = false;
  std::optional<Step> reading_;  // for this one
  std::deque<Step> waiting_;     // behind it
  unsigned run_ = 0;             // an answer to another is ignored
};

}  // namespace palpate::plugin
