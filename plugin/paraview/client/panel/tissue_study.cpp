#include "plugin/paraview/client/panel/tissue_study.h"

#include <QCoreApplication>

#include <utility>

namespace palpate::plugin {

TissueStudy::TissueStudy(SceneModel& model, SessionController& session, QWidget* parent)
    : QProgressBar(parent), model_(model), session_(session) {
  setObjectName(QStringLiteral("palpateStudying"));
  setFormat(tr("Looking for tissues %p%"));
  hide();
  connect(&model, &SceneModel::changed, this, [this] {
    if (session_.expects_scan()) return;  // what is felt is the one before
    if (const auto felt = session_.live().felt_scan(); felt && felt != studied_.lock()) study(felt);
  });
  // The thread ends before ParaView goes.
  connect(QCoreApplication::instance(), &QCoreApplication::aboutToQuit, this, [this] { job_.finish(); });
}

void TissueStudy::study(const std::shared_ptr<const io::Volume>& volume) {
  proposes_ = true;
  begin(volume);
}

void TissueStudy::study_frame(const std::shared_ptr<const io::Volume>& volume) {
  if (volume != studied_.lock()) begin(volume);
}

void TissueStudy::begin(const std::shared_ptr<const io::Volume>& volume) {
  studied_ = volume;
  setValue(0);
  setVisible(proposes_);  // at another frame nothing moves in the panel
  job_.study(
      volume, [this](double done) { setValue(static_cast<int>(100 * done)); },
      [this, unit = QString::fromStdString(volume->unit)](const auto& study, const std::string& error) {
        hide();
        if (study) take(study, unit);
        if (!error.empty()) emit model_.refused(QString::fromStdString(error));
      });
}

void TissueStudy::take(const std::shared_ptr<const ScanStudy>& study, const QString& unit) {
  emit studied(study, unit);
  session_.set_sites(study->sites);
  if (!std::exchange(proposes_, false)) return;
  std::optional<modes::Scene> found = study->suggested;
  if (found) found->workspace = model_.scene().workspace;
  emit proposed(found);
  // A felt or edited scene is not replaced under the user's hand.
  if (found && !model_.is_edited() && !session_.live().is_connected()) model_.propose(*found);
}

void TissueStudy::cancel() {
  job_.cancel();
  hide();
  studied_.reset();
  proposes_ = false;
}

}  // namespace palpate::plugin
