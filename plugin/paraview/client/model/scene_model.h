#pragma once

/// Owns the scene that the panel edits. ParaView's pipeline keeps its text, so ParaView's undo, state files and traces
/// include every edit. A change that needs files waits until they are read; later changes wait behind it, and all are
/// made in order.

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
#include "plugin/paraview/client/model/mode_ids.h"

namespace palpate::plugin {

class SceneModel : public QObject {
  Q_OBJECT

 public:
  /// May be called later, after other changes, and more than once: it must own its data. May throw with the reason why
  /// the scene cannot be changed so.
  using Change = std::function<void(modes::Scene&)>;
  /// Passes a scene to the stylus, or throws with the reason why it cannot be felt.
  using Commit = std::function<void(const modes::Scene&, Pace)>;
  /// Gets the reason why a change was refused, or an empty text if it was accepted.
  using Told = std::function<void(const QString& why)>;

  explicit SceneModel(KeptText& kept, QObject* parent = nullptr);

  /// Called once for every scene, before anything else gets it. A scene that it refuses is refused for panel, pipeline
  /// and stylus alike. Without it a scene only has to be valid.
  void set_commit(Commit commit) { commit_ = std::move(commit); }

  /// Prepares in the background the parts of a scene that take long; then returns true, and calls `ready` once. False:
  /// there is nothing to prepare.
  using MakeReady = std::function<bool(const modes::Scene& scene, std::function<void()> ready)>;
  /// Called for a scene from the pipeline (undo, a trace, the property panel). Until it is ready the previous scene
  /// stays. A newer scene replaces the one that is being prepared.
  void set_make_ready(MakeReady make_ready) { make_ready_ = std::move(make_ready); }
  /// The same for every change: reads the files that the scene needs. `done` gets an error if they cannot be read; the
  /// change is then refused. Called again after `done`, because the scan may have changed.
  using Read = std::function<bool(const modes::Scene& scene, std::function<void(const QString& error)> done)>;
  void set_read(Read read) { read_ = std::move(read); }
  /// Whether a change waits.
  bool is_waiting() const { return reading_ || !waiting_.empty(); }
  /// Whether no change is on its way: none waits, no scene of the pipeline is being prepared, and no earlier one is
  /// held (show_before()). An earlier one that is shown only because the user's latest cannot be read does not count.
  bool is_settled() const;
  /// Another scan: drops the waiting changes, which were meant for the previous one, except the pipeline's scene.
  void drop_waiting();
  /// `clean` removes the parts of a scene in the pipeline that do not belong there, and returns whether it removed any.
  /// If so, the pipeline gets the cleaned scene.
  void set_clean(std::function<bool(modes::Scene&)> clean) { clean_ = std::move(clean); }
  /// The pipeline holds a scene that was refused: sets it back to the scene that is felt.
  void put_back();

  const modes::Scene& scene() const { return scene_; }
  /// The user's latest scene, also while an earlier one is shown instead.
  const modes::Scene& latest() const { return shown_before_ ? shown_before_->now : scene_; }
  bool shows_before() const { return shown_before_.has_value(); }
  const ModeIds& mode_ids() const { return mode_ids_; }
  /// The scene as last opened or proposed, without later edits.
  const modes::Scene& opened() const { return opened_; }
  /// The scene in the pipeline, and so in a state file; none if it keeps none, or an invalid one.
  std::optional<modes::Scene> kept() const;
  /// Whether the scene is no longer the one that was opened or proposed.
  bool is_edited() const { return edited_; }

  /// Opens a completely different scene. Makes a place in the pipeline if there is none yet.
  void open(const modes::Scene& scene);
  /// The place in the pipeline was deleted: makes another one, with the present scene. Undo would bring the deleted one
  /// back beside it, so the steps until now are forgotten.
  void reopen();
  /// A scene that the panel proposes itself; not a step that can be undone. Returns whether it was accepted.
  bool propose(const modes::Scene& scene);
  /// One step that can be undone; `what` names it in ParaView's menu. A refused change leaves the scene unchanged. The
  /// reason goes to `told`, which shows it beside the pressed button; without `told`, refused() reports it. The change
  /// is applied to the scene at the time when its turn comes, with all earlier changes.
  void edit(const QString& what, const Change& change, const Told& told = {});
  /// The same for a mode of the present scene, wherever it is when the change's turn comes; refused if it is gone.
  void edit_mode(const QString& what, std::size_t mode, std::function<void(modes::Mode&)> change,
                 const Told& told = {});
  /// A change in progress, such as dragging a node. It is felt at once; of waiting ones only the newest is applied.
  /// Together with the finish_drag() that ends it, it is one step.
  void drag(const Change& change, const Told& told = {});
  void finish_drag(const QString& what);
  /// A change that is not a step by itself: felt with a step's ramp, and kept by the next step or by finish_drag().
  void pass(const Change& change, const Told& told = {});

  /// Shows and offers the scene as it was before the last edit, until show_now(), the next change or another scan. It
  /// is no step, and the pipeline keeps the present scene. Filter and mapping stay, and edits of these alone are passed
  /// over. Does nothing while a change waits, or if there is no earlier scene.
  void show_before();
  void show_now();

  bool can_undo() const { return kept_.can_undo(); }
  void undo() { kept_.undo(); }
  void redo() { kept_.redo(); }
  /// Another scan: edits of the previous scan's scene can no longer be undone here.
  void forget_steps();

 signals:
  void changed(palpate::plugin::Pace pace);
  /// A scene was refused that no button caused: one from the pipeline, or from a file.
  void refused(const QString& why);

 private:
  struct Step {
    enum class Kind { edit, drag, pass, finish, text, before, now };
    Kind kind = Kind::edit;
    QString what;
    Change change;
    Told told;
    std::string text;  ///< the pipeline's; replaced by a newer one
  };
  void follow_text();
  void make_ready(const std::string& text);
  void put(Step step);
  void run(const Step& step);
  void run_text(const Step& step);
  bool waits_for(const modes::Scene& scene, const Step& step);
  void finish_reading(const QString& error);
  void go_on();
  /// Why it was refused; empty: it was accepted.
  QString take(const modes::Scene& scene, Pace pace);
  void tell(const QString& why, const Told& told);
  void refuse_text(const QString& why);
  void keep(const QString& what);
  std::optional<modes::Scene> before_last_edit() const;

  KeptText& kept_;
  Commit commit_;
  MakeReady make_ready_;
  Read read_;
  std::function<bool(modes::Scene&)> clean_;
  modes::Scene scene_, opened_;
  ModeIds mode_ids_;  // of scene_
  std::string text_;  // of the scene, as in the pipeline
  bool edited_ = false;
  struct Texts {
    std::string before, after;
  };
  std::deque<Texts> edits_;  // the last ones, oldest first
  struct ShownBefore {
    modes::Scene now;
    bool is_held = true;  ///< its end was not asked for
    bool ends = false;    ///< `now` is on its way back
  };
  std::optional<ShownBefore> shown_before_;
  std::optional<Step> reading_;  // its files are being read
  std::deque<Step> waiting_;     // the steps after it
  unsigned run_ = 0;             // number of the current reading; other answers are ignored
};

}  // namespace palpate::plugin
