#include "PalpatePanel.h"

#include <pqActiveObjects.h>

#include <QDialog>
#include <QEvent>
#include <QGroupBox>
#include <QScrollArea>
#include <QTimer>
#include <QVBoxLayout>

#include "scan_section.h"

using palpate::plugin::ScanSection;

namespace {

/// ParaView's welcome stands in front of a scan that was asked for.
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

/// A folder named on the command line of `plugin/run view`, once ParaView has a server to show it with.
void open_first_folder(ScanSection& scan) {
  const QByteArray folder = qgetenv("PALPATE_OPEN");
  if (folder.isEmpty()) return;
  QCoreApplication::instance()->installEventFilter(new NoWelcome(&scan));
  auto* const waiting = new QTimer(&scan);
  QObject::connect(waiting, &QTimer::timeout, &scan, [waiting, &scan, folder] {
    if (!pqActiveObjects::instance().activeServer() || !pqActiveObjects::instance().activeView()) return;
    waiting->stop();  // its end may be long in coming where a script runs the event loop
    waiting->deleteLater();
    scan.open(folder.toStdString());
  });
  constexpr int poll_ms = 100;
  waiting->start(poll_ms);
}

}  // namespace

PalpatePanel::PalpatePanel(QWidget* parent) : QDockWidget(tr("Palpate"), parent) {
  setObjectName(QStringLiteral("PalpatePanel"));
  auto* const content = new QWidget(this);
  auto* const column = new QVBoxLayout(content);
  auto* const scan_box = new QGroupBox(tr("Scan"), content);
  auto* const scan = new ScanSection(scan_box);
  (new QVBoxLayout(scan_box))->addWidget(scan);
  column->addWidget(scan_box);
  column->addStretch(1);
  auto* const scroll = new QScrollArea(this);
  scroll->setObjectName(QStringLiteral("palpateScroll"));
  scroll->setWidgetResizable(true);
  scroll->setHorizontalScrollBarPolicy(Qt::ScrollBarAlwaysOff);
  scroll->setFrameShape(QFrame::NoFrame);
  scroll->setWidget(content);
  scroll->setMinimumWidth(280);
  setWidget(scroll);
  open_first_folder(*scan);
}
