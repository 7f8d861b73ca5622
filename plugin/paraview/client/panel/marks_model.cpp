#include "plugin/paraview/client/panel/marks_model.h"

#include <pqCoreUtilities.h>
#include <vtkCommand.h>
#include <vtkSMProxy.h>

#include <exception>
#include <utility>

#include "plugin/paraview/client/panel/kept_property.h"

namespace palpate::plugin {

MarksModel::MarksModel(SceneModel& scenes, QObject* parent) : QObject(parent), scenes_(scenes) {
  connect(&scenes, &SceneModel::sourced, this, [this](pqPipelineSource& source) { attach(source); });
}

const Marks& MarksModel::marks() const {
  static const Marks none;
  const auto found = kept_.find(scan_);
  return found == kept_.end() ? none : found->second;
}

void MarksModel::set_scan(const std::string& scan) {
  scan_ = scan;
  emit changed();
}

/// A source without marks gets those that are here: they are of scans, and not of a session.
void MarksModel::attach(pqPipelineSource& source) {
  source_ = &source;
  pqCoreUtilities::connect(source.getProxy(), vtkCommand::PropertyModifiedEvent, this, SLOT(follow_source()));
  text_.clear();
  if (!kept_text_of(source, "Marks").empty()) return follow_source();
  text_ = kept_text(kept_);
  if (text_.empty()) return;
  keeping_ = true;
  put_text(source, "Marks", text_);
  keeping_ = false;
}

/// What changed the source need not have been the panel: undo, a trace, a state file.
void MarksModel::follow_source() {
  if (keeping_ || !source_) return;
  const std::string text = kept_text_of(*source_, "Marks");
  if (text == text_) return;
  try {
    kept_ = marks_of_text(text);
    text_ = text;
    emit changed();
  } catch (const std::exception& error) {
    keeping_ = true;
    put_text(*source_, "Marks", text_ = kept_text(kept_));
    keeping_ = false;
    emit refused(QString::fromUtf8(error.what()));
  }
}

void MarksModel::edit(const QString& what, const Change& change) {
  if (scan_.empty() || !source_) return;
  Marks& marks = kept_[scan_];
  change(marks);
  measure_again(marks);
  std::string text = kept_text(kept_);
  if (text == text_) return;
  text_ = std::move(text);
  keeping_ = true;
  keep_text(*source_, "Marks", text_, what);
  keeping_ = false;
  emit changed();
}

void MarksModel::add(const MarkMade& made) {
  if (scan_.empty() || !source_) return;
  const bool is_mark = std::holds_alternative<FeltMark>(made);
  edit(is_mark ? tr("Mark") : tr("Mark a path"), [&](Marks& marks) {
    if (is_mark) {
      marks.points.push_back(std::get<FeltMark>(made));
      marks.points.back().name.clear();
      marks.points.back().name = free_mark_name(marks);
    } else {
      marks.paths.push_back(std::get<MarkedPath>(made));
      marks.paths.back().name.clear();
      marks.paths.back().name = free_path_name(marks);
    }
  });
  emit added();
}

}  // namespace palpate::plugin
