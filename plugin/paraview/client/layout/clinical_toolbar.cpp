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

#include <utility>

#include "plugin/paraview/client/scan/recent_folders.h"
#include "plugin/paraview/client/widgets/kept_width.h"
#include "plugin/paraview/client/widgets/release_button.h"

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

/// What a ruler or an angle draws.
QIcon measure_icon(const QPalette& colors, Measure measure) {
  constexpr int side = 64, edge = 8, thick = 6, mark = 5;
  QPixmap picture(side, side);
  picture.fill(Qt::transparent);
  QPainter painter(&picture);
  painter.setRenderHint(QPainter::Antialiasing);
  const QColor& ink = colors.color(QPalette::ButtonText);
  painter.setPen(QPen(ink, thick));
  painter.setBrush(ink);
  const QPoint left(edge, side - edge), right(side - edge, edge), across(side - edge, side - edge);
  painter.drawLine(left, right);
  if (measure == Measure::angle) {
    painter.drawLine(left, across);
  } else {
    painter.drawEllipse(left, mark, mark);
    painter.drawEllipse(right, mark, mark);
  }
  return QIcon(picture);
}

}  // namespace

ClinicalToolbar::ClinicalToolbar(QComboBox& window, QComboBox& look, QWidget* parent)
    : QToolBar(tr("Palpate"), parent) {
  setObjectName(QStringLiteral("palpateToolbar"));
  setToolButtonStyle(Qt::ToolButtonTextBesideIcon);
  setIconSize({22, 22});
  add_open();
  addSeparator();
  addWidget(new QLabel(tr("Window "), this));
  addWidget(&window);
  addWidget(make_volume_menu());
  addWidget(&look);
  addSeparator();
  add_layouts();
  addSeparator();
  add_measures();
  addSeparator();
  add_connection();
  addSeparator();
  QAction* const picture = add("palpatePicture", tr("Picture…"), tr("Saves what the views show as a PNG file"));
  connect(picture, &QAction::triggered, this, &ClinicalToolbar::picture_wanted);
  // After Release, which a narrow window is to keep.
  marks_ = add("palpateToolbarMarks", tr("Marks"), tr("Shows the marks, and the distances and angles between them"));
  connect(marks_, &QAction::triggered, this, &ClinicalToolbar::marks_wanted);
  marks_->setVisible(false);
  auto* const gap = new QWidget(this);
  gap->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Preferred);
  addWidget(gap);
  advanced_ = add("palpateAdvanced", tr("Advanced"), tr("Shows ParaView's own toolbars, pipeline and properties"));
  advanced_->setCheckable(true);
  connect(advanced_, &QAction::triggered, this, &ClinicalToolbar::advanced_wanted);
  show_connection(false, false);
}

/// Opens a folder, or one of those that were opened before.
void ClinicalToolbar::add_open() {
  QAction* const open =
      add("palpateToolbarOpen", tr("Open…"), tr("Opens a folder of DICOM files, with all its subfolders"));
  open->setIcon(style()->standardIcon(QStyle::SP_DirOpenIcon));
  connect(open, &QAction::triggered, this, &ClinicalToolbar::open_wanted);
  auto* const recent = new QMenu(this);
  recent->setObjectName(QStringLiteral("palpateRecent"));
  connect(recent, &QMenu::aboutToShow, this, [this, recent] {
    recent->clear();
    for (const QString& folder : recent_folders()) {
      connect(recent->addAction(folder), &QAction::triggered, this, [this, folder] { emit folder_wanted(folder); });
    }
    if (recent->isEmpty()) recent->addAction(tr("No folder has been opened yet"))->setEnabled(false);
  });
  open->setMenu(recent);
  qobject_cast<QToolButton*>(widgetForAction(open))->setPopupMode(QToolButton::MenuButtonPopup);
}

/// Four views or one.
void ClinicalToolbar::add_layouts() {
  four_ = add("palpateFourUp", tr("Four-up"), tr("Four-up: axial, sagittal, coronal and volume beside each other"));
  one_ =
      add("palpateOneUp", tr("One-up"), tr("One-up: the active view alone. A double click in a view does the same."));
  four_->setIcon(layout_icon(palette(), 2));
  one_->setIcon(layout_icon(palette(), 1));
  auto* const group = new QActionGroup(this);
  for (QAction* const layout : {four_, one_}) {
    layout->setCheckable(true);
    qobject_cast<QToolButton*>(widgetForAction(layout))->setToolButtonStyle(Qt::ToolButtonIconOnly);
    group->addAction(layout);
  }
  four_->setChecked(true);
  connect(four_, &QAction::triggered, this, [this] { emit enlarged_wanted(false); });
  connect(one_, &QAction::triggered, this, [this] { emit enlarged_wanted(true); });
}

void ClinicalToolbar::add_measures() {
  ruler_ = add("palpateRuler", tr("Ruler"),
               tr("Drag in a slice to measure a length (key L). The delete key deletes the last measurement."));
  angle_ = add("palpateAngle", tr("Angle"),
               tr("In a slice, drag along one leg of the angle, then click at the end of the other leg (key A)."));
  for (const auto& [action, what] : {std::pair{ruler_, Measure::ruler}, {angle_, Measure::angle}}) {
    action->setCheckable(true);
    action->setIcon(measure_icon(palette(), what));
    qobject_cast<QToolButton*>(widgetForAction(action))->setToolButtonStyle(Qt::ToolButtonIconOnly);
    connect(action, &QAction::triggered, this,
            [this, what = what](bool on) { emit measure_wanted(on ? what : Measure::none); });
  }
}

/// Connect and Release.
void ClinicalToolbar::add_connection() {
  connect_ = add("palpateToolbarConnect", tr("Connect stylus"), {});
  keep_width(*qobject_cast<QToolButton*>(widgetForAction(connect_)), {tr("Connect stylus"), tr("Disconnect stylus")});
  connect(connect_, &QAction::triggered, this, &ClinicalToolbar::connect_wanted);
  release_ = make_release_button(*this, "palpateToolbarRelease", tr("Release  (Esc)"));
  release_->setToolTip(tr("Takes the force away"));
  release_->setMinimumSize(130, 32);
  release_->setFocusPolicy(Qt::NoFocus);  // the arrow keys are the views'
  connect(release_, &QPushButton::clicked, this, &ClinicalToolbar::release_wanted);
  addWidget(release_);
}

/// What else can be done with the volume, behind its name.
QToolButton* ClinicalToolbar::make_volume_menu() {
  auto* const button = new QToolButton(this);
  button->setObjectName(QStringLiteral("palpateVolumeMenu"));
  button->setText(tr("Volume"));
  button->setToolTip(tr("Hides parts of the volume"));
  button->setPopupMode(QToolButton::InstantPopup);
  auto* const menu = new QMenu(button);
  cut_ = menu->addAction(tr("Without table and headrest"));
  cut_->setObjectName(QStringLiteral("palpateCutTable"));
  crop_ = menu->addAction(tr("Crop box"));
  crop_->setObjectName(QStringLiteral("palpateCropBox"));
  crop_->setToolTip(tr("Drag its handles in the volume view"));
  for (QAction* const action : {cut_, crop_}) {
    action->setCheckable(true);
    action->setEnabled(false);
  }
  connect(cut_, &QAction::triggered, this, &ClinicalToolbar::cut_wanted);
  connect(crop_, &QAction::triggered, this, &ClinicalToolbar::crop_wanted);
  button->setMenu(menu);
  return button;
}

void ClinicalToolbar::show_volume_cuts(bool can_cut, bool can_crop) {
  if (can_cut != cut_->isEnabled()) cut_->setChecked(can_cut);
  cut_->setEnabled(can_cut);
  if (!can_crop) crop_->setChecked(false);
  crop_->setEnabled(can_crop);
}

QAction* ClinicalToolbar::add(const char* name, const QString& text, const QString& tip) {
  QAction* const action = addAction(text);
  action->setObjectName(QString::fromLatin1(name));
  action->setToolTip(tip);
  widgetForAction(action)->setObjectName(QString::fromLatin1(name) + QStringLiteral("Button"));
  return action;
}

void ClinicalToolbar::show_connection(bool connected, bool can_connect) {
  connect_->setText(connected ? tr("Disconnect stylus") : tr("Connect stylus"));
  connect_->setToolTip(connected ? tr("Disconnects the stylus")
                                 : tr("Connects the stylus that is chosen in the panel"));
  connect_->setEnabled(can_connect);
  release_->setEnabled(connected);
}

void ClinicalToolbar::show_enlarged(bool enlarged) {
  (enlarged ? one_ : four_)->setChecked(true);
}

void ClinicalToolbar::show_measure(Measure measure) {
  ruler_->setChecked(measure == Measure::ruler);
  angle_->setChecked(measure == Measure::angle);
}

void ClinicalToolbar::show_marks(const QString& words) {
  marks_->setText(tr("Marks (%1)").arg(words));
  marks_->setVisible(!words.isEmpty());
}

void ClinicalToolbar::show_advanced(bool advanced) {
  advanced_->setChecked(advanced);
}

}  // namespace palpate::plugin
