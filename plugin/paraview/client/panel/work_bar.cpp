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
    emit told(words(say("cancelled")), false);
  });
  row->addWidget(cancel);
  hide();
}

void WorkBar::begin(const QString& doing, std::function<Said(const Job&)> work) {
  progress_->setRange(0, 0);
  progress_->setFormat(doing);
  show();
  work_.ask(std::move(work), [this](const auto& said, const QString& error) {
    hide();
    said ? emit told(said->message, said->problem) : emit told(error, true);
  });
  emit told({}, false);  // it is busy now
}

void WorkBar::tell_progress(const Job& job, int done, int all, const QString& doing) {
  job.tell([this, done, all, doing] {
    progress_->setRange(0, all);
    progress_->setValue(done);
    if (!doing.isEmpty()) progress_->setFormat(doing);
  });
}

}  // namespace palpate::plugin
