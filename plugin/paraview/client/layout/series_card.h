#pragma once

/// A series as a card: its picture, its distinguishing details, and the reason if it cannot be felt.

#include <QCoreApplication>
#include <QPushButton>

class QImage;
class QLabel;

namespace palpate::io {
struct Series;
}

namespace palpate::plugin {

class SeriesCard : public QPushButton {
  Q_DECLARE_TR_FUNCTIONS(SeriesCard)

 public:
  /// `best`: why this series is recommended to be felt first; empty if it is not.
  SeriesCard(const io::Series& series, const QString& best, QWidget* parent = nullptr);

  void set_picture(const QImage& picture);

  // As large as its contents: a plain button takes only its text into account.
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;
  bool hasHeightForWidth() const override { return true; }
  int heightForWidth(int width) const override;

 private:
  QLabel* picture_;
};

}  // namespace palpate::plugin
