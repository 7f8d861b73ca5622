#include "plugin/paraview/client/model/marks_model.h"

#include <exception>
#include <utility>

namespace palpate::plugin {
namespace {

constexpr const char* marks_key = "Marks";

}  // namespace

MarksModel::MarksModel(KeptText& kept, QObject* parent) : QObject(parent), in_pipeline_(kept) {
  connect(&kept, &KeptText::opened, this, [this] { attach(); });
  connect(&kept, &KeptText::changed, this, [this] { follow_text(); });
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

void MarksModel::forget() {
  kept_.clear();
  text_.clear();
  emit changed();
}

/// A place without marks gets the present ones: they belong to scans, not to a session.
void MarksModel::attach() {
  text_.clear();
  if (!in_pipeline_.text(marks_key).empty()) return follow_text();
  text_ = kept_text(kept_);
  if (!text_.empty()) in_pipeline_.put(marks_key, text_);
}

void MarksModel::follow_text() {
  const std::string text = in_pipeline_.text(marks_key);
  if (!in_pipeline_.is_open() || text == text_) return;
  try {
    kept_ = marks_of_text(text);
    text_ = text;
    emit changed();
  } catch (const std::exception& error) {
    text_ = kept_text(kept_);
    in_pipeline_.put(marks_key, text_);
    emit refused(QString::fromUtf8(error.what()));
  }
}

void MarksModel::edit(const QString& what, const Change& change) {
  if (scan_.empty() || !in_pipeline_.is_open()) return;
  Marks& marks = kept_[scan_];
  change(marks);
  measure_again(marks);
  std::string text = kept_text(kept_);
  if (text == text_) return;
  text_ = std::move(text);
  in_pipeline_.keep(marks_key, text_, what);
  emit changed();
}

void MarksModel::add(const MarkMade& made) {
  const bool is_mark = std::holds_alternative<FeltMark>(made);
  if (scan_.empty() || !in_pipeline_.is_open()) return;
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
