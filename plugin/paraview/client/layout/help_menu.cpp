#include "plugin/paraview/client/layout/help_menu.h"

#include <QAction>
#include <QCoreApplication>
#include <QDialog>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QMessageBox>
#include <QPointer>
#include <QTextBrowser>
#include <QTextDocument>
#include <QUrl>
#include <QVBoxLayout>

namespace palpate::plugin {
namespace {

QString translated(const char* text) {
  return QCoreApplication::translate("HelpMenu", text);
}

void show_guide(QMainWindow& window) {
  static QPointer<QDialog> guide;
  if (!guide) {
    guide = new QDialog(&window);
    guide->setObjectName(QStringLiteral("palpateGuide"));
    guide->setWindowTitle(translated("Palpate guide"));
    auto* const column = new QVBoxLayout(guide);
    auto* const text = new QTextBrowser(guide);
    text->setObjectName(QStringLiteral("palpateGuideText"));
    text->setOpenExternalLinks(true);
    text->setSource(QUrl(QStringLiteral("qrc:/palpate/guide.md")), QTextDocument::MarkdownResource);
    column->addWidget(text);
    constexpr int width = 820, height = 640;
    guide->resize(width, height);
  }
  guide->show();
  guide->raise();
  guide->activateWindow();
}

void show_about(QMainWindow& window) {
  QMessageBox about(&window);
  about.setObjectName(QStringLiteral("palpateAboutBox"));
  about.setWindowTitle(translated("About Palpate"));
  about.setTextFormat(Qt::RichText);
  about.setText(
      translated("<h3>Palpate %1</h3><p>Feel a CT or MR scan with a haptic stylus.</p>"
                 "<p><b>Research software, not a medical device.</b></p>"
                 "<p>Apache License 2.0. Runs in %2; the libraries that it uses and their licenses are listed in "
                 "its package.</p>")
          .arg(QStringLiteral(PALPATE_VERSION), QCoreApplication::applicationName()));
  about.exec();
}

QMenu* help_menu(QMainWindow& window) {
  for (QAction* const entry : window.menuBar()->actions()) {
    if (entry->menu() && entry->menu()->objectName().contains(QLatin1String("help"), Qt::CaseInsensitive)) {
      return entry->menu();
    }
  }
  return window.menuBar()->addMenu(translated("Help"));
}

}  // namespace

void add_help(QMainWindow& window) {
  QMenu& menu = *help_menu(window);
  // Of two actions with one key neither is triggered.
  for (QAction* const other : window.findChildren<QAction*>()) {
    if (other->shortcut() == QKeySequence(Qt::Key_F1)) other->setShortcut({});
  }
  QAction* const first = menu.actions().isEmpty() ? nullptr : menu.actions().first();
  auto* const guide = new QAction(translated("Palpate guide"), &window);
  guide->setObjectName(QStringLiteral("palpateGuideAction"));
  guide->setShortcut(Qt::Key_F1);
  guide->setShortcutContext(Qt::ApplicationShortcut);
  QObject::connect(guide, &QAction::triggered, &window, [&window] { show_guide(window); });
  auto* const about = new QAction(translated("About Palpate"), &window);
  about->setObjectName(QStringLiteral("palpateAboutAction"));
  QObject::connect(about, &QAction::triggered, &window, [&window] { show_about(window); });
  menu.insertAction(first, guide);
  menu.insertAction(first, about);
  menu.insertSeparator(first);
}

}  // namespace palpate::plugin
