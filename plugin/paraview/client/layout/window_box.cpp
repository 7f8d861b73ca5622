#include "plugin/paraview/client/layout/window_box.h"

#include <QCoreApplication>

#include <algorithm>

namespace palpate::plugin {
namespace {

QString of_section(const char* text) {
  return QCoreApplication::translate("palpate::plugin::ScanSection", text);
}

bool is_same(const NamedWindow& one, const NamedWindow& other) {
  return one.name == other.name && one.window.level == other.window.level && one.window.width == other.window.width;
}

}  // namespace

WindowBox::WindowBox(ScanModel& model, ClinicalViews& views, QWidget* parent)
    : QComboBox(parent), model_(model), views_(views) {
  setObjectName(QStringLiteral("palpateWindow"));
  setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  setMinimumContentsLength(14);
  connect(this, QOverload<int>::of(&QComboBox::activated), this, [this](int choice) {
    const auto n = static_cast<std::size_t>(choice);
    if (choice >= 0 && n < views_.windows().size()) views_.set_window(views_.windows()[n].window);
  });
  views.set_window_changed([this] { show_window(); });
  connect(&model, &ScanModel::changed, this, [this] { follow(); });
  follow();
}

/// The scan that is in the views, once all of them are made.
void WindowBox::follow() {
  const bool making = std::holds_alternative<in_views::Showing>(model_.in_views());
  setEnabled(model_.seen() && !model_.on_its_way());
  if (making) return;
  std::ranges::equal(listed_, views_.windows(), is_same) ? show_window() : list();
}

void WindowBox::list() {
  listed_ = views_.windows();
  clear();
  for (const NamedWindow& named : listed_) {
    addItem(QStringLiteral("%1 (%2 / %3)")
                .arg(of_section(named.name))
                .arg(named.window.level, 0, 'g', 4)
                .arg(named.window.width, 0, 'g', 4));
    setItemData(count() - 1, of_section("Key %1").arg(count()), Qt::ToolTipRole);
  }
  show_window();
}

void WindowBox::show_window() {
  choose();
  // The box is too narrow for some.
  const QString keys =
      of_section("Keys 1 to 9. Also: drag in a slice, to the right for a wider window, up for a brighter one.");
  setToolTip(currentText().isEmpty() ? keys : currentText() + QLatin1Char('\n') + keys);
}

/// The slices' window; if it has no name, as an additional entry.
void WindowBox::choose() {
  const int custom = static_cast<int>(listed_.size());
  const Window& now = views_.window();
  const auto same = std::ranges::find_if(
      listed_, [&](const NamedWindow& of) { return of.window.level == now.level && of.window.width == now.width; });
  if (same != listed_.end() || listed_.empty()) {
    removeItem(custom);
    setCurrentIndex(listed_.empty() ? -1 : static_cast<int>(same - listed_.begin()));
    return;
  }
  if (count() == custom) addItem(QString());
  setItemText(custom, of_section("Custom (%1 / %2)").arg(now.level, 0, 'f', 0).arg(now.width, 0, 'f', 0));
  setCurrentIndex(custom);
}

}  // namespace palpate::plugin
