#pragma once

/// Lies over ParaView's views while those of a scan are made, one after the other: nobody sees an empty one.

#include <QPointer>
#include <QString>
#include <QWidget>

class QMainWindow;

namespace palpate::plugin {

class ViewsCover : public QWidget {
 public:
  /// Not in sight yet. Never is where this ParaView has its views elsewhere.
  explicit ViewsCover(QMainWindow& window);

  void set_shown(bool shown);
  /// What stands in its middle.
  void set_words(const QString& words);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

 private:
  QPointer<QWidget> views_;
  QString words_;
};

}  // namespace palpate::plugin
