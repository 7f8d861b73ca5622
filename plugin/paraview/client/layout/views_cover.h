#pragma once

/// Covers ParaView's views while those of a scan are made one after the other, so that no empty view is seen.

#include <QPointer>
#include <QString>
#include <QWidget>

class QMainWindow;

namespace palpate::plugin {

class ViewsCover : public QWidget {
 public:
  /// Hidden at first, and always if this version of ParaView has its views elsewhere.
  explicit ViewsCover(QMainWindow& window);

  void set_shown(bool shown);
  /// The text in its middle.
  void set_words(const QString& words);

 protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

 private:
  QPointer<QWidget> views_;
  QString words_;
};

}  // namespace palpate::plugin
