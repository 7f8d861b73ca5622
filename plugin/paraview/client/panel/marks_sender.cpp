#include "plugin/paraview/client/panel/marks_sender.h"

#include <utility>

#include "io/fresh_folder.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/words.h"
#include "plugin/paraview/client/words/patient_words.h"
#include "plugin/report/mark_results.h"

namespace palpate::plugin {

MarksSender::MarksSender(QWidget* parent) : WorkBar(QStringLiteral("palpateSending"), parent) {}

void MarksSender::send(const io::Archive& archive, const io::Series& series,
                       const std::shared_ptr<const io::Volume>& volume, const Marks& marks,
                       std::function<void()> done) {
  set_patient(patient_in_words(series.identity.patient_name));
  const auto work = [this, archive, series, volume, marks](const Job::Control& job) {
    const io::FreshFolder folder = io::temporary_folder();
    const auto files = write_results(series, volume, marks, folder.path());
    const int all = static_cast<int>(files.size());
    const io::Sent sent = io::send(archive, files, [&](std::size_t sent_now) {
      tell_progress(job, static_cast<int>(sent_now), all, tr("%1 of %2 files").arg(sent_now).arg(all));
      return job.keep_going();
    });
    return said_of(sent, archive.name);
  };
  begin(tr("Writing the report"), work, std::move(done));
}

WorkBar::Said MarksSender::said_of(const io::Sent& sent, const std::string& archive) {
  if (sent.not_sent.empty()) {
    const QString warned = sent.warned.empty() ? QString() : QLatin1Char('\n') + words(sent.warned.front().why);
    return {words(say("marks-are-sent", archive, sent.files - 1)) + warned};
  }
  return {words(say("files-not-sent", sent.not_sent.size(), sent.files + sent.not_sent.size())) + QLatin1Char('\n') +
              words(sent.not_sent.front().why),
          true};
}

}  // namespace palpate::plugin
