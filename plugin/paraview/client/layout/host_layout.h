#pragma once

/// ParaView's own toolbars and panels around the views: hidden for a clinician, shown under "Advanced".

#include <QList>
#include <QObject>
#include <QPointer>

class QDockWidget;
class QMainWindow;
class QToolBar;
class QWidget;

namespace palpate::plugin {

class HostLayout : public QObject {
  Q_OBJECT

 public:
  /// Everything in `window` except that toolbar and that panel counts as ParaView's. Waits until the window is shown
  /// and ParaView has arranged it. If the pipeline already holds something else, the layout is left as it is.
  HostLayout(QMainWindow& window, QToolBar& toolbar, QDockWidget& panel, QObject* parent);

  /// The choice is kept for the next start of the program.
  void set_advanced(bool advanced);
  /// To be called after views or tabs were added: adapts them to the layout.
  void refresh_tabs();

 signals:
  void advanced_changed(bool advanced);

 private:
  void begin();
  void let_key_save_state();
  void place_first();
  void hide_host();
  void show_host();

  QMainWindow& window_;
  QToolBar& toolbar_;
  QDockWidget& panel_;
  QList<QPointer<QWidget>> hidden_;  // ParaView's, hidden by us
  bool advanced_ = true;             // until ParaView has arranged its window
};

}  // namespace palpate::plugin
