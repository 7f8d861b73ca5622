#include "plugin/paraview/client/model/structure_presses.h"

#include <exception>
#include <utility>

namespace palpate::plugin {

StructurePresses::StructurePresses(SceneModel& model, Read read, Told told)
    : model_(model), read_(std::move(read)), told_(std::move(told)) {}

void StructurePresses::press(const QString& what, SceneModel::Change edit, const QString& note) {
  waiting_.push_back({what, std::move(edit), note});
  if (waiting_.size() == 1) begin();
}

void StructurePresses::drop() {
  ++run_;
  waiting_.clear();
}

/// Of the scene as it is now: the press before is part of it.
void StructurePresses::begin() {
  modes::Scene edited = model_.scene();
  waiting_.front().edit(edited);
  read_(edited, [this, run = ++run_](const QString& error) {
    if (run == run_) finish(error);
  });
}

void StructurePresses::finish(const QString& error) {
  const Press done = std::move(waiting_.front());
  waiting_.pop_front();
  if (error.isEmpty()) {
    model_.edit(done.what, done.edit, [&](const QString& why) {
      told_(why.isEmpty() ? done.note : why, !why.isEmpty() || !done.note.isEmpty());
    });
  } else {
    told_(error, true);
  }
  if (!waiting_.empty()) begin();
}

}  // namespace palpate::plugin
