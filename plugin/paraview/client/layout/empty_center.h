#pragma once

/// The start page in ParaView's center. It is there while the pipeline is empty, in place of empty views.

#include <QObject>
#include <QPointer>
#include <QTimer>

class QMainWindow;
class QWidget;

namespace palpate::plugin {

class EmptyCenter : public QObject {
 public:
  /// Puts the page beside ParaView's views; not in sight yet. Does nothing if this ParaView has its views elsewhere.
  EmptyCenter(QMainWindow& window, QWidget& page, QObject* parent);

  /// Whether ParaView is as it is without us: then its own views stay.
  void set_advanced(bool advanced);

 private:
  void refresh();

  QPointer<QWidget> views_;
  QPointer<QWidget> page_;
  QTimer soon_;  // a scan that takes another's place leaves nothing empty
  bool advanced_ = true;
};

}  // namespace palpate::plugin
