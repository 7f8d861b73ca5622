#pragma once

#include <QObject>

/// Runs the scenario named by PALPATE_PANEL_TEST and ends the program: 0 if it passed.
class PanelTest : public QObject {
  Q_OBJECT

 public:
  explicit PanelTest(QObject* parent = nullptr) : QObject(parent) {}
  void on_startup();
  void on_shutdown() {}
};
