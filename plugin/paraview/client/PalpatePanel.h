#pragma once

/// The dock panel.

#include <QDockWidget>

#include <memory>

class PalpatePanel : public QDockWidget {
  Q_OBJECT

 public:
  explicit PalpatePanel(QWidget* parent = nullptr);
  ~PalpatePanel() override;

 protected:
  /// Esc, wherever it is pressed, releases the force.
  bool eventFilter(QObject* watched, QEvent* event) override;

  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};
