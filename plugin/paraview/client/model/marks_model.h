#pragma once

/// Owns the marks of the scan that is shown; views and list query it. ParaView's pipeline keeps them beside the scene,
/// so undo, state files and traces include them. It also keeps the marks of other scans.

#include <QObject>
#include <QString>

#include <functional>
#include <string>

#include "plugin/paraview/client/model/kept_text.h"
#include "plugin/report/kept_marks.h"

namespace palpate::plugin {

class MarksModel : public QObject {
  Q_OBJECT

 public:
  using Change = std::function<void(Marks&)>;

  explicit MarksModel(KeptText& kept, QObject* parent = nullptr);

  /// The marks of the scan that is shown.
  const Marks& marks() const;
  /// Sets the scan by its hash_of_series(); empty: none.
  void set_scan(const std::string& scan);
  bool has_scan() const { return !scan_.empty(); }
  const std::string& scan() const { return scan_; }
  const MarksOfScans& of_all_scans() const { return kept_; }

  /// Forgets the marks of all scans: a state file brings its own, or none.
  void forget();

  /// One step that can be undone; `what` names it in ParaView's menu. Distances and angles are computed again.
  void edit(const QString& what, const Change& change);
  /// Adds the result of a press, with a name.
  void add(const MarkMade& made);
  /// Undoes the last step, whether of marks or of the scene.
  void undo() { in_pipeline_.undo(); }

 signals:
  void changed();
  /// A press has made a mark or a path.
  void added();
  void refused(const QString& why);

 private:
  void attach();
  void follow_text();

  KeptText& in_pipeline_;
  MarksOfScans kept_;
  std::string scan_;
  std::string text_;  // of the marks, as in the pipeline
};

}  // namespace palpate::plugin
