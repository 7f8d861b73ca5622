#pragma once

/// The dock panel.

#include <QCoreApplication>
#include <QDockWidget>

class PalpatePanel : public QDockWidget {
  Q_DECLARE_TR_FUNCTIONS(PalpatePanel)

 public:
  explicit PalpatePanel(QWidget* parent = nullptr);
};
