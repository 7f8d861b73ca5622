#include "plugin/paraview/client/scan/first_folder.h"

#include <pqActiveObjects.h>

#include <QCoreApplication>
#include <QDialog>
#include <QEvent>
#include <QTimer>

namespace palpate::plugin {
namespace {

class NoWelcome : public QObject {
 public:
  using QObject::QObject;

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override {
    if (event->type() == QEvent::Show && watched->inherits("pqWelcomeDialog")) {
      QTimer::singleShot(0, static_cast<QDialog*>(watched), &QDialog::reject);
    }
    return false;
  }
};

}  // namespace

void open_first_folder(QObject& parent, const std::function<void(const std::string&)>& open) {
  QCoreApplication::instance()->installEventFilter(new NoWelcome(&parent));
  const QByteArray folder = qgetenv("PALPATE_OPEN");
  if (folder.isEmpty()) return;
  auto* const waiting = new QTimer(&parent);
  QObject::connect(waiting, &QTimer::timeout, &parent, [waiting, open, folder] {
    if (!pqActiveObjects::instance().activeServer() || !pqActiveObjects::instance().activeView()) return;
    waiting->stop();
    waiting->deleteLater();
    open(folder.toStdString());
  });
  constexpr int poll_ms = 100;
  waiting->start(poll_ms);
}

}  // namespace palpate::plugin
