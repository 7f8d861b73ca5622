#pragma once

/// "Save picture…" and "Save table…" below a chart.

#include <QCoreApplication>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QPushButton>

#include <array>
#include <exception>
#include <functional>
#include <string>

namespace palpate::plugin {

struct SaveButtons {
  std::array<QPushButton*, 2> both{};  ///< picture, table
};

/// `name`: part of the buttons' names (palpate<name>Picture, palpate<name>Table) and, in small letters, of the proposed
/// file. `writer` returns a function that writes what is shown at the press, even if the chart changes while the user
/// names the file; it may throw. `tell` gets error messages.
inline SaveButtons add_save_buttons(
    QBoxLayout& column, QWidget& parent, const QString& name,
    const std::function<std::function<void(const std::string& file)>(bool table)>& writer,
    const std::function<void(const QString& problem)>& tell) {
  const auto tr = [](const char* text) { return QCoreApplication::translate("SaveButtons", text); };
  SaveButtons buttons;
  auto* const row = new QHBoxLayout;
  for (const bool table : {false, true}) {
    auto* const button = new QPushButton(table ? tr("Save table…") : tr("Save picture…"), &parent);
    button->setObjectName(QStringLiteral("palpate") + name +
                          (table ? QStringLiteral("Table") : QStringLiteral("Picture")));
    QObject::connect(button, &QPushButton::clicked, &parent, [=, &parent] {
      const auto write = writer(table);
      const QString file =
          QFileDialog::getSaveFileName(&parent, table ? tr("Save table") : tr("Save picture"),
                                       name.toLower() + (table ? QStringLiteral(".csv") : QStringLiteral(".png")),
                                       table ? tr("Tables (*.csv)") : tr("Pictures (*.png)"));
      if (file.isEmpty() || !write) return;
      try {
        write(file.toStdString());
      } catch (const std::exception& error) {
        tell(QString::fromUtf8(error.what()));
      }
    });
    row->addWidget(button);
    buttons.both[table ? 1 : 0] = button;
  }
  column.addLayout(row);
  return buttons;
}

}  // namespace palpate::plugin
