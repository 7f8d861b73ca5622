#include "plugin/paraview/client/panel/work_bar.h"

#include <QHBoxLayout>
#include <QProgressBar>
#include <QPushButton>

#include <utility>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/words.h"

namespace palpate::plugin {

WorkBar::WorkBar(const QString& name, QWidget* parent) : QWidget(parent), progress_(new QProgressBar(this)) {
  auto* const row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  progress_->setObjectName(name);
  row->addWidget(progress_, 1);
  auto* const cancel = new QPushButton(tr("Cancel"), this);
  cancel->setObjectName(name + QStringLiteral("Cancel"));
  connect(cancel, &QPushButton::clicked, this, [this] {
    work_.cancel();
    hide();
    emit told(for_whom(words(say("cancelled"))), false);
  });
  row->addWidget(cancel);
  hide();
}

void WorkBar::begin(const QString& doing, std::function<Said(const Job::Control&)> work, std::function<void()> done) {
  left_ = false;
  progress_->setRange(0, 0);
  show_doing(doing);
  show();
  work_.ask(std::move(work), [this, done = std::move(done)](const auto& said, const QString& error) {
    hide();
    said ? emit told(for_whom(said->message), said->problem) : emit told(for_whom(error), true);
    if (said && !said->problem && done) done();
  });
  emit told({}, false);  // it is busy now
}

void WorkBar::leave_scan() {
  if (!is_busy() || std::exchange(left_, true)) return;
  show_doing(progress_->format());
}

QString WorkBar::for_whom(const QString& text) const {
  return left_ && !patient_.isEmpty() ? QStringLiteral("%1: %2").arg(patient_, text) : text;
}

void WorkBar::show_doing(const QString& doing) {
  progress_->setFormat(for_whom(doing));
}

void WorkBar::tell_progress(const Job::Control& job, int done, int all, const QString& doing) {
  job.tell([this, done, all, doing] {
    progress_->setRange(0, all);
    progress_->setValue(done);
    if (!doing.isEmpty()) show_doing(doing);
  });
}

}  // namespace palpate::plugin
