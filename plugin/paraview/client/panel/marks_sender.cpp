#include "plugin/paraview/client/panel/marks_sender.h"

#include <QHBoxLayout>
#include <QProgressBar>
#include <QPushButton>

#include "io/fresh_folder.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/words.h"
#include "plugin/report/mark_results.h"

namespace palpate::plugin {

MarksSender::MarksSender(QWidget* parent) : QWidget(parent), progress_(new QProgressBar(this)) {
  auto* const row = new QHBoxLayout(this);
  row->setContentsMargins(0, 0, 0, 0);
  progress_->setObjectName(QStringLiteral("palpateSending"));
  row->addWidget(progress_, 1);
  auto* const cancel = new QPushButton(tr("Cancel"), this);
  cancel->setObjectName(QStringLiteral("palpateSendCancel"));
  connect(cancel, &QPushButton::clicked, this, [this] {
    sending_.cancel();
    hide();
    emit told(words(say("cancelled")), false);
  });
  row->addWidget(cancel);
  hide();
}

void MarksSender::send(const io::Archive& archive, const io::Series& series,
                       const std::shared_ptr<const io::Volume>& volume, const Marks& marks) {
  progress_->setRange(0, 0);
  progress_->setFormat(tr("Writing the report"));
  show();
  emit told({}, false);
  sending_.ask(
      [this, archive, series, volume, marks](const auto& job) {
        const io::FreshFolder folder = io::temporary_folder();
        const auto files = write_results(series, volume, marks, folder.path());
        const int all = static_cast<int>(files.size());
        return io::send(archive, files, [&](std::size_t done) {
          job.tell([this, all, done] {
            progress_->setRange(0, all);
            progress_->setValue(static_cast<int>(done));
            progress_->setFormat(tr("%1 of %2 files").arg(done).arg(all));
          });
          return job.keep_going();
        });
      },
      [this, name = archive.name](const auto& sent, const QString& error) {
        hide();
        if (sent) take(*sent, name);
        if (!sent) emit told(error, true);
      });
}

void MarksSender::take(const io::Sent& sent, const std::string& archive) {
  if (sent.not_sent.empty()) {
    const QString warned = sent.warned.empty() ? QString() : QLatin1Char('\n') + words(sent.warned.front().why);
    emit told(words(say("marks-are-sent", archive, sent.files - 1)) + warned, false);
    return;
  }
  const QString why = words(sent.not_sent.front().why);
  emit told(
      words(say("files-not-sent", sent.not_sent.size(), sent.files + sent.not_sent.size())) + QLatin1Char('\n') + why,
      true);
}

}  // namespace palpate::plugin
