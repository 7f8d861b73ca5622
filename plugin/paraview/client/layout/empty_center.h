#pragma once

/// The start page in ParaView's center, shown in place of empty views while the pipeline is empty.

#include <QObject>
#include <QPointer>
#include <QTimer>

class QMainWindow;
class QWidget;

namespace palpate::plugin {

class EmptyCenter : public QObject {
 public:
  /// Adds the page beside ParaView's views, still hidden. Does nothing if this version of ParaView has its views
  /// elsewhere.
  EmptyCenter(QMainWindow& window, QWidget& page, QObject* parent);

  /// Whether ParaView's own interface is shown: then its own views stay.
  void set_advanced(bool advanced);

 private:
  void refresh();

  QPointer<QWidget> views_;
  QPointer<QWidget> page_;
  QTimer soon_;  // delayed, so that the page does not appear when one scan replaces another
  bool advanced_ = true;
};

}  // namespace palpate::plugin
