#include "plugin/paraview/client/layout/clinical_toolbar.h"

#include <QAction>
#include <QActionGroup>
#include <QComboBox>
#include <QIcon>
#include <QLabel>
#include <QMenu>
#include <QPainter>
#include <QPixmap>
#include <QPushButton>
#include <QStyle>
#include <QToolButton>

#include "plugin/paraview/client/scan/recent_folders.h"

namespace palpate::plugin {
namespace {

/// A picture of how the views are laid out: `across` by `across` of them.
QIcon layout_icon(const QPalette& colors, int across) {
  constexpr int side = 64, gap = 8;
  QPixmap picture(side, side);
  picture.fill(Qt::transparent);
  QPainter painter(&picture);
  painter.setPen(Qt::NoPen);
  painter.setBrush(colors.color(QPalette::ButtonText));
  const int cell = (side - (across + 1) * gap) / across;
  for (int row = 0; row < across; ++row) {
    for (int column = 0; column < across; ++column) {
      painter.drawRect(gap + column * (cell + gap), gap + row * (cell + gap), cell, cell);
    }
  }
  return QIcon(picture);
}

}  // namespace

ClinicalToolbar::ClinicalToolbar(QComboBox& window, QComboBox& look, QWidget* parent)
    : QToolBar(tr("Palpate"), parent) {
  setObjectName(QStringLiteral("palpateToolbar"));
  setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  setIconSize({22, 22});
  QAction* const open = add("palpateToolbarOpen", tr("Open…"), tr("A folder of DICOM files, searched to the bottom"));
  open->setIcon(style()->standardIcon(QStyle::SP_DirOpenIcon));
  connect(open, &QAction::triggered, this, &ClinicalToolbar::open_wanted);
  auto* const recent = new QMenu(this);
  recent->setObjectName(QStringLiteral("palpateRecent"));
  connect(recent, &QMenu::aboutToShow, this, [this, recent] {
    recent->clear();
    for (const QString& folder : recent_folders()) {
      connect(recent->addAction(folder), &QAction::triggered, this, [this, folder] { emit folder_wanted(folder); });
    }
    if (recent->isEmpty()) recent->addAction(tr("No folder was opened yet"))->setEnabled(false);
  });
  open->setMenu(recent);
  qobject_cast<QToolButton*>(widgetForAction(open))->setPopupMode(QToolButton::MenuButtonPopup);
  addSeparator();
  addWidget(new QLabel(tr("Window "), this));
  addWidget(&window);
  addWidget(new QLabel(tr("  Volume "), this));
  addWidget(&look);
  addSeparator();
  four_ = add("palpateFourUp", tr("Four-up"), tr("Axial, sagittal, coronal and volume beside each other"));
  one_ = add("palpateOneUp", tr("One-up"), tr("The marked view alone. A double click in a view does the same."));
  four_->setIcon(layout_icon(palette(), 2));
  one_->setIcon(layout_icon(palette(), 1));
  auto* const group = new QActionGroup(this);
  for (QAction* const layout : {four_, one_}) {
    layout->setCheckable(true);
    group->addAction(layout);
  }
  four_->setChecked(true);
  connect(four_, &QAction::triggered, this, [this] { emit enlarged_wanted(false); });
  connect(one_, &QAction::triggered, this, [this] { emit enlarged_wanted(true); });
  addSeparator();
  connect_ = add("palpateToolbarConnect", tr("Connect"), {});
  connect(connect_, &QAction::triggered, this, &ClinicalToolbar::connect_wanted);
  release_ = new QPushButton(tr("Release  (Esc)"), this);
  release_->setObjectName(QStringLiteral("palpateToolbarRelease"));
  release_->setToolTip(tr("Takes the force away"));
  release_->setMinimumSize(130, 32);
  release_->setFocusPolicy(Qt::NoFocus);  // the arrow keys are the views'
  release_->setStyleSheet(
      QStringLiteral("QPushButton { background: #b00020; color: white; font-weight: bold; border-radius: 4px }"
                     "QPushButton:pressed { background: #7a0016 }"
                     "QPushButton:disabled { background: palette(mid); color: palette(dark) }"));
  connect(release_, &QPushButton::clicked, this, &ClinicalToolbar::release_wanted);
  addWidget(release_);
  addSeparator();
  QAction* const picture = add("palpatePicture", tr("Picture…"), tr("Saves what the views show as a PNG file"));
  connect(picture, &QAction::triggered, this, &ClinicalToolbar::picture_wanted);
  auto* const gap = new QWidget(this);
  gap->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  addWidget(gap);
  advanced_ = add("palpateAdvanced", tr("Advanced"), tr("ParaView's own toolbars, pipeline and properties"));
  advanced_->setCheckable(true);
  connect(advanced_, &QAction::triggered, this, &ClinicalToolbar::advanced_wanted);
  show_connection(false, false);
}

QAction* ClinicalToolbar::add(const char* name, const QString& text, const QString& tip) {
  QAction* const action = addAction(text);
  action->setObjectName(QString::fromLatin1(name));
  action->setToolTip(tip);
  widgetForAction(action)->setObjectName(QString::fromLatin1(name) + QStringLiteral("Button"));
  return action;
}

void ClinicalToolbar::show_connection(bool connected, bool can_connect) {
  connect_->setText(connected ? tr("Disconnect") : tr("Connect"));
  connect_->setToolTip(connected ? tr("Lets the stylus go") : tr("Takes the stylus that the panel names"));
  connect_->setEnabled(can_connect);
  release_->setEnabled(connected);
}

void ClinicalToolbar::show_enlarged(bool enlarged) {
  (enlarged ? one_ : four_)->setChecked(true);
}

void ClinicalToolbar::show_advanced(bool advanced) {
  advanced_->setChecked(advanced);
}

}  // namespace palpate::plugin
