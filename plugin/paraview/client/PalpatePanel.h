#pragma once

/// The dock panel.

#include <QDockWidget>

#include <memory>

namespace palpate::plugin {
struct PanelParts;
class Translation;
}  // namespace palpate::plugin

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
  void mark_by_key(const QKeyEvent& event);
  bool correct_by_key(const QKeyEvent& event);
  void let_go_keys();

  std::unique_ptr<palpate::plugin::Translation> translation_;  // first: the other members need its texts
  std::unique_ptr<palpate::plugin::PanelParts> parts_;
};
