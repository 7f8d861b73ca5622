#pragma once

/// A series as a card: its picture, what tells it from the others, and why it cannot be felt where it cannot.

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
  /// `best`: why it is the one to feel first; empty where it is not.
  SeriesCard(const io::Series& series, const QString& best, QWidget* parent = nullptr);

  void set_picture(const QImage& picture);

  // As large as what it shows: a button alone knows its text.
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override;
  bool hasHeightForWidth() const override { return true; }
  int heightForWidth(int width) const override;

 private:
  QLabel* picture_;
};

}  // namespace palpate::plugin
