#include "plugin/paraview/client/PalpatePanel.h"

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqCoreUtilities.h>
#include <pqPipelineSource.h>
#include <pqQVTKWidget.h>
#include <pqRenderView.h>
#include <pqServerManagerModel.h>
#include <pqUndoStack.h>
#include <vtkPVXMLElement.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMProxyLocator.h>
#include <vtkSMSourceProxy.h>

#include <QAbstractButton>
#include <QAbstractSlider>
#include <QAbstractSpinBox>
#include <QApplication>
#include <QCheckBox>
#include <QComboBox>
#include <QCoreApplication>
#include <QDragEnterEvent>
#include <QDropEvent>
#include <QFileDialog>
#include <QHBoxLayout>
#include <QKeyEvent>
#include <QLabel>
#include <QMainWindow>
#include <QMimeData>
#include <QProgressBar>
#include <QPushButton>
#include <QTimer>
#include <QUrl>
#include <QVBoxLayout>

#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <utility>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/layout/clinical_toolbar.h"
#include "plugin/paraview/client/layout/enlarged_view.h"
#include "plugin/paraview/client/layout/help_menu.h"
#include "plugin/paraview/client/layout/host_layout.h"
#include "plugin/paraview/client/layout/view_picture.h"
#include "plugin/paraview/client/layout/volume_look_box.h"
#include "plugin/paraview/client/panel/column_scroll.h"
#include "plugin/paraview/client/panel/curves_section.h"
#include "plugin/paraview/client/panel/fold.h"
#include "plugin/paraview/client/panel/footer.h"
#include "plugin/paraview/client/panel/modes_section.h"
#include "plugin/paraview/client/panel/profile_section.h"
#include "plugin/paraview/client/panel/recordings_section.h"
#include "plugin/paraview/client/panel/structures_section.h"
#include "plugin/paraview/client/panel/tissues_section.h"
#include "plugin/paraview/client/remote/server_series.h"
#include "plugin/paraview/client/remote/server_watch.h"
#include "plugin/paraview/client/scan/filter_row.h"
#include "plugin/paraview/client/scan/first_folder.h"
#include "plugin/paraview/client/scan/scan_section.h"
#include "plugin/paraview/client/stylus/mapping.h"
#include "plugin/paraview/client/stylus/start_place.h"
#include "plugin/paraview/client/stylus/stylus_section.h"
#include "plugin/paraview/client/stylus/stylus_views.h"
#include "plugin/paraview/client/views/boundary_colors.h"
#include "plugin/paraview/client/views/boundary_contours.h"
#include "plugin/paraview/client/views/flow_views.h"
#include "plugin/paraview/client/views/image_lattice.h"
#include "plugin/paraview/client/views/reference_lines.h"
#include "plugin/paraview/client/words.h"
#include "plugin/session/scan.h"

using namespace palpate;
using namespace palpate::plugin;

namespace {

void focus_marked_view() {
  if (QApplication::activeModalWidget() || QApplication::activePopupWidget()) return;
  pqView* const marked = pqActiveObjects::instance().activeView();
  if (!marked) return;
  auto* const frame = qobject_cast<pqQVTKWidget*>(marked->widget());
  QWidget* const picture = frame ? frame->renderWidget() : marked->widget();
  // What is drawn may be a window of its own, in a container that hands the keys on.
  for (QWidget* const child : picture->findChildren<QWidget*>()) {
    if (!child->inherits("QWindowContainer")) continue;
    child->setFocus();
    return;
  }
  picture->setFocus();
}

}  // namespace

/// In the order in which they lean on each other.
struct PalpatePanel::Parts {
  explicit Parts(PalpatePanel& panel) : dock(panel), touching(model), views(touching, model) {}

  void build();
  void build_layout();
  void ask_picture();
  void enlarge(bool enlarged);
  void leave(const QString& why);
  void leave_server();
  void note_scan(const ScanHandle& handle);
  void adopt_state();
  void show_scan(const ScanHandle& handle);
  void show_frame(const ScanHandle& handle);
  void name_felt();
  glm::dvec3 start_of(const device::Specification& stylus);
  void leave_views();
  void read_opacity();
  void study(const std::shared_ptr<const io::Volume>& volume);
  void change_volume(const std::function<void(vtkSMProxy&)>& change);
  void color_views();
  void draw_contours();
  void look(const SessionStatus& seen);

  PalpatePanel& dock;
  SceneModel model;
  SessionController touching;
  FlowViews flow;
  BoundaryContours contours;
  ReferenceLines crosshair;
  StylusViews views;
  ServerWatch servers;
  Fold* scan_fold = nullptr;
  Fold* recordings_fold = nullptr;
  Footer* footer = nullptr;
  ScanSection* scan = nullptr;
  FilterRow* filter = nullptr;
  TissuesSection* tissues = nullptr;
  Fold* structures_fold = nullptr;
  StructuresSection* structures = nullptr;
  StylusSection* stylus = nullptr;
  CurvesSection* curves = nullptr;
  ModesSection* modes = nullptr;
  ProfileSection* profile = nullptr;
  RecordingsSection* recordings = nullptr;
  QProgressBar* studying = nullptr;
  ClinicalToolbar* toolbar = nullptr;
  HostLayout* layout = nullptr;
  VolumeLookBox* look_box = nullptr;
  bool restoring = false;  // the scan to come is a state file's
  bool leaving = false;    // a server
  bool edited = false;     // since the scan was shown
  bool proposing = false;  // what is being edited is the panel's own doing
  double low = 0, high = 1;
  std::weak_ptr<const io::Volume> studied;  // for its tissues
  std::uint64_t followed = 0;               // last frame of a recording that the slices followed
  ScanLoader studies;                       // last: its thread is to end before all that its callbacks use
};

void PalpatePanel::Parts::build() {
  auto* const content = new QWidget(&dock);
  auto* const column = new QVBoxLayout(content);
  column->setContentsMargins(6, 2, 6, 2);
  column->setSpacing(4);
  scan = new ScanSection;
  filter = new FilterRow(model, touching, *scan, scan);
  scan->layout()->addWidget(filter);
  scan_fold = new Fold(tr("Scan"), QStringLiteral("palpateScanSection"), scan, true, content);
  column->addWidget(scan_fold);
  column->addWidget(&scan->notes());
  auto* const tissues_box = new QWidget;
  auto* const tissues_column = new QVBoxLayout(tissues_box);
  tissues_column->setContentsMargins(0, 0, 0, 0);
  tissues = new TissuesSection(model, tissues_box);
  tissues_column->addWidget(tissues);
  studying = new QProgressBar(tissues_box);
  studying->setObjectName(QStringLiteral("palpateStudying"));
  studying->setFormat(tr("Looking for tissues %p%"));
  studying->hide();
  tissues_column->addWidget(studying);
  auto* const drawn = new QCheckBox(tr("Boundaries on the slices"), tissues_box);
  drawn->setObjectName(QStringLiteral("palpateContours"));
  drawn->setToolTip(tr("A line where each boundary is met, in its color. It follows what you tune."));
  drawn->setChecked(true);
  QObject::connect(drawn, &QCheckBox::toggled, &dock, [this](bool on) { contours.set_visible(on); });
  auto* const crossed = new QCheckBox(tr("Crosshair"), tissues_box);
  crossed->setObjectName(QStringLiteral("palpateCrosshair"));
  crossed->setToolTip(tr("Where the other two slices lie. Moving the pointer with Shift held down takes them along."));
  QObject::connect(crossed, &QCheckBox::toggled, &dock, [this](bool on) { crosshair.set_visible(on); });
  auto* const shown_lines = new QHBoxLayout;
  shown_lines->addWidget(drawn, 1);
  shown_lines->addWidget(crossed);
  tissues_column->addLayout(shown_lines);
  column->addWidget(new Fold(tr("Tissues"), QStringLiteral("palpateTissuesSection"), tissues_box, true, content));
  structures = new StructuresSection(model, touching);
  structures_fold = new Fold(tr("Structures"), QStringLiteral("palpateStructuresSection"), structures, false, content);
  column->addWidget(structures_fold);
  stylus = new StylusSection(touching, model, [this] { return views.eye(); });
  column->addWidget(new Fold(tr("Stylus"), QStringLiteral("palpateStylusSection"), stylus, true, content));
  curves = new CurvesSection(model);
  column->addWidget(new Fold(tr("Transfer function"), QStringLiteral("palpateCurvesSection"), curves, false, content));
  modes = new ModesSection(model, touching);
  column->addWidget(new Fold(tr("Modes"), QStringLiteral("palpateModesSection"), modes, false, content));
  profile = new ProfileSection(touching, model);
  column->addWidget(new Fold(tr("Force profile"), QStringLiteral("palpateProfileSection"), profile, false, content));
  recordings = new RecordingsSection(touching);
  recordings_fold = new Fold(tr("Recordings"), QStringLiteral("palpateRecordingsSection"), recordings, false, content);
  column->addWidget(recordings_fold);
  auto* const about = new QLabel(
      tr("Palpate %1. Research software, not a medical device.").arg(QStringLiteral(PALPATE_VERSION)), content);
  about->setObjectName(QStringLiteral("palpateAbout"));
  about->setWordWrap(true);
  about->setEnabled(false);
  column->addWidget(about);
  column->addStretch(1);

  auto* const whole = new QWidget(&dock);
  auto* const halves = new QVBoxLayout(whole);
  halves->setContentsMargins(0, 0, 0, 0);
  halves->setSpacing(0);
  halves->addWidget(new ColumnScroll(QStringLiteral("palpateScroll"), content, whole), 1);
  halves->addWidget(footer = new Footer(touching, model, whole));
  dock.setWidget(whole);
  build_layout();

  QObject::connect(scan, &ScanSection::closing, &dock, [this] {
    touching.release();  // before another scan takes its place
    leave_views();
  });
  QObject::connect(scan, &ScanSection::out_of_reach, &dock, [this](const QString& why) { touching.set_no_scan(why); });
  QObject::connect(scan, &ScanSection::scan_shown, &dock, [this](const ScanHandle& handle) { show_scan(handle); });
  QObject::connect(scan, &ScanSection::frame_shown, &dock, [this](const ScanHandle& handle) { show_frame(handle); });
  QObject::connect(stylus, &StylusSection::stylus_wanted, &dock, [this] {
    SCOPED_UNDO_EXCLUDE();
    if (touching.last().is_seen()) scan->views().show_point(touching.last().proxy_mm);
  });
  scan->views().set_slice_shown([this](SliceView& slice) {
    flow.show(slice);
    contours.show(slice);
    crosshair.refresh();
    structures->show(slice);
  });
  scan->views().set_leafed([this] { stylus->pause_following(); });
  QObject::connect(structures, &StructuresSection::listed, &dock,
                   [this] { structures_fold->set_note(structures->in_words()); });
  touching.set_start([this](const device::Specification& device) { return start_of(device); });
  QObject::connect(&touching, &SessionController::recorded, recordings, [this](const QString& file) {
    recordings_fold->set_open(true);
    recordings->open(file);
  });
  QObject::connect(profile, &ProfileSection::picking, &dock, [this](bool on) {
    touching.keep_mouse_off(on);
    if (on) read_opacity();  // it may have been edited in ParaView since
    const auto pick = on ? [this](Pick what, const glm::dvec3& place) { profile->pick(what, place); }
                         : std::function<void(Pick, const glm::dvec3&)>{};
    scan->views().set_pick(pick);
    views.set_pick(pick);
  });
  QObject::connect(&model, &SceneModel::changed, &dock, [this](Pace pace) {
    if (!proposing) edited = true;
    if (pace == Pace::stepped) color_views();
    if (const auto felt = touching.live().felt_scan(); felt && felt != studied.lock()) study(felt);
    draw_contours();
  });
  QObject::connect(&touching, &SessionController::looked, &dock, [this](const SessionStatus& seen) { look(seen); });
  QObject::connect(&touching, &SessionController::connection_changed, &dock, [this] {
    modes->refresh();
    servers.be_attentive(touching.live().is_connected());
  });
  // The threads end before ParaView goes, and before a server takes the views away.
  QObject::connect(QCoreApplication::instance(), &QCoreApplication::aboutToQuit, &dock, [this] {
    studies.cancel();
    QObject::disconnect(&touching, &SessionController::recorded, recordings, nullptr);  // nobody looks at it any more
    touching.disconnect_stylus();
  });
  QObject::connect(&servers, &ServerWatch::leaving, &dock, [this] { leave_server(); });
  QObject::connect(&servers, &ServerWatch::lost, &dock, [this] { leave(words(say("server-is-lost"))); });
  QObject::connect(pqApplicationCore::instance(), &pqApplicationCore::stateLoaded, &dock, [this] { adopt_state(); });
  open_first_folder(dock, [this](const std::string& folder) { scan->open(folder); });
}

/// ParaView's window as a clinician's: one toolbar, the views, the panel.
void PalpatePanel::Parts::build_layout() {
  auto* const window = qobject_cast<QMainWindow*>(pqCoreUtilities::mainWidget());
  look_box = new VolumeLookBox(window);
  toolbar = new ClinicalToolbar(scan->window_box(), *look_box, window);
  QObject::connect(look_box, &VolumeLookBox::felt_chosen, &dock, [this] { color_views(); });
  QObject::connect(look_box, &VolumeLookBox::look_chosen, &dock, [this](const VolumeLook& chosen) {
    change_volume([&](vtkSMProxy& volume) { set_volume_look(volume, chosen); });
  });
  window->addToolBar(Qt::TopToolBarArea, toolbar);
  layout = new HostLayout(*window, *toolbar, dock, &dock);
  add_help(*window);
  QObject::connect(toolbar, &ClinicalToolbar::folder_wanted, &dock,
                   [this](const QString& folder) { scan->open(folder.toStdString()); });
  QObject::connect(toolbar, &ClinicalToolbar::picture_wanted, &dock, [this] { ask_picture(); });
  QObject::connect(toolbar, &ClinicalToolbar::open_wanted, &dock, [this] { scan->ask_folder(); });
  QObject::connect(toolbar, &ClinicalToolbar::enlarged_wanted, &dock, [this](bool enlarged) { enlarge(enlarged); });
  QObject::connect(toolbar, &ClinicalToolbar::connect_wanted, stylus, &StylusSection::connect_or_not);
  QObject::connect(toolbar, &ClinicalToolbar::release_wanted, &dock, [this] { touching.release(); });
  QObject::connect(toolbar, &ClinicalToolbar::advanced_wanted, layout, &HostLayout::set_advanced);
  QObject::connect(layout, &HostLayout::advanced_changed, toolbar, &ClinicalToolbar::show_advanced);
  QObject::connect(stylus, &StylusSection::connection_shown, toolbar, &ClinicalToolbar::show_connection);
  scan->views().set_enlarged_changed([this](bool enlarged) { toolbar->show_enlarged(enlarged); });
}

void PalpatePanel::Parts::ask_picture() {
  auto* const marked = qobject_cast<pqRenderView*>(pqActiveObjects::instance().activeView());
  if (!marked) return;
  QFileDialog dialog(&dock, tr("Save a picture of the views"), {}, tr("Pictures (*.png)"));
  dialog.setAcceptMode(QFileDialog::AcceptSave);
  dialog.setDefaultSuffix(QStringLiteral("png"));
  if (dialog.exec() != QDialog::Accepted || dialog.selectedFiles().isEmpty()) return;
  const QString file = dialog.selectedFiles().first();
  if (!save_picture(*marked, file)) {
    emit touching.told(
        words(say("panel-cannot-write", file.toStdString(), tr("no such folder, or no right to it").toStdString())),
        true);
  }
}

void PalpatePanel::Parts::enlarge(bool enlarged) {
  auto* const marked = qobject_cast<pqRenderView*>(pqActiveObjects::instance().activeView());
  if (marked) set_enlarged(*marked, enlarged);
}

/// In good order: another server, none, or a new session.
void PalpatePanel::Parts::leave_server() {
  if (remote_server()) {
    const bool records = touching.live().recording().has_value();
    leave(records ? words(say("left-the-server-recording")) : words(say("left-the-server")));
    return;
  }
  touching.keep_off(words(say("paraview-session-ended")));
  scan->server_gone();
  leave_views();
}

/// All that a server has goes, and what is held of it is let go: first the force, and the recording with it.
void PalpatePanel::Parts::leave(const QString& why) {
  if (std::exchange(leaving, true)) return;  // what follows may ask the lost server, which tells that it is lost
  const bool held = touching.live().is_connected();
  touching.set_no_scan({});
  if (held) emit touching.told(why, true);  // before the views, which may find that their server does not answer
  scan->server_gone();
  leave_views();
  leaving = false;
}

/// What a state file has restored is taken over: scan, scene and views.
void PalpatePanel::Parts::adopt_state() {
  touching.release();
  const auto sources = pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>();
  pqPipelineSource* reader = nullptr;
  pqPipelineSource* scene = nullptr;
  for (pqPipelineSource* const source : sources) {
    const std::string kind = source->getProxy()->GetXMLName();
    if (kind == "PalpateDicomReader") reader = source;
    if (kind == "PalpateScene") scene = source;
  }
  const bool another = reader && reader != scan->source();
  if (another) touching.expect_scan();
  if (scene) model.adopt(*scene);
  if (!another) return;
  restoring = true;
  scan->adopt(*reader);
}

void PalpatePanel::Parts::show_scan(const ScanHandle& handle) {
  pqServer* const server = pqActiveObjects::instance().activeServer();
  if (!server) return;
  proposing = true;
  const bool restored = std::exchange(restoring, false) && model.source();
  touching.release();
  if (!restored) {
    modes::Scene scene = scene_for("", *handle.volume);
    scene.workspace.fit = true;
    touching.expect_scan();  // the scene is for this scan, not for the last one
    model.open(*server, scene);
  }
  touching.set_scan(handle.volume);
  model.forget_steps();
  tissues->forget_scan();
  if (restored) tissues->set_restored();
  const std::vector<ClinicalView> shown = scan->views().views();
  contours.set_views(shown);
  crosshair.set_views(shown);
  structures->set_views(shown);
  profile->set_views(shown);
  recordings->set_views(shown);
  views.set_views(shown);  // last: the stylus is drawn over the paths
  look_box->set_looks(scan->views().looks(), scan->views().first_look());
  read_opacity();
  const ImageLattice lattice = lattice_of(*vtkSMSourceProxy::SafeDownCast(scan->source()->getProxy()));
  low = lattice.values.low;
  high = lattice.values.high;
  flow.set_views(shown);
  flow.set_volume(handle.volume);
  filter->refresh();
  draw_contours();
  touching.begin_outside();
  proposing = false;
  edited = restored;
  structures->set_scan(handle.volume, vtkSMPropertyHelper(scan->source()->getProxy(), "FileName").GetAsString());
  note_scan(handle);
  scan_fold->set_open(false);
  layout->refresh_tabs();
  study(handle.volume);
}

void PalpatePanel::Parts::show_frame(const ScanHandle& handle) {
  touching.set_scan(handle.volume);
  flow.set_volume(handle.volume);
  draw_contours();
  note_scan(handle);
}

void PalpatePanel::Parts::note_scan(const ScanHandle& handle) {
  const QString scan_words = QString::fromStdString(describe_scan(*handle.volume));
  scan_fold->set_note(handle.frames > 1 ? QStringLiteral("%1, %2").arg(scan_words, handle.frame_in_words())
                                        : scan_words);
}

/// Scan, frame and scene: what the stylus has, whatever is looked at.
void PalpatePanel::Parts::name_felt() {
  const ScanHandle& handle = scan->handle();
  if (!handle.volume) {
    footer->set_felt(tr("No scan is open."));
    return;
  }
  const QStringList others = scan->others_shown();
  const QString through = filter->in_words();
  const QString felt =
      tr("Felt: %1. Scene: %2.")
          .arg(through.isEmpty() ? handle.in_words() : handle.in_words() + QStringLiteral(", ") + through,
               tissues->scene_in_words());
  footer->set_felt(others.isEmpty() ? felt
                                    : felt + QLatin1Char(' ') +
                                          tr("Also shown, not felt: %1.").arg(others.join(QStringLiteral(", "))));
}

/// In sight, in reach and outside of anything felt.
glm::dvec3 PalpatePanel::Parts::start_of(const device::Specification& of) {
  const LiveSession& live = touching.live();
  const auto plan = live.plan();
  const auto& volume = live.felt_scan();
  const auto in_reach = [&](const glm::dvec3& place) {
    constexpr double margin = 0.95;
    const glm::dvec3 at = glm::abs(plan->workspace.to_device(place));
    return glm::all(glm::lessThan(at, margin * of.workspace_half_extent));
  };
  const StartPlace start = find_start_place(
      volume, *plan, live.scene().gradient_scale_mm.value_or(io::default_gradient_scale_mm(volume->geometry)), in_reach,
      [this](const glm::dvec3& place) { return views.shows(place); });
  if (!start.outside) {
    QMetaObject::invokeMethod(
        &dock, [this] { emit touching.told(words(say("no-place-outside-the-patient")), true); }, Qt::QueuedConnection);
  }
  return start.place_mm;
}

void PalpatePanel::Parts::leave_views() {
  contours.set_views({});
  crosshair.set_views({});
  flow.set_views({});
  structures->set_scan(nullptr, {});
  structures->set_views({});
  views.set_views({});
  profile->set_views({});
  recordings->set_views({});
}

void PalpatePanel::Parts::study(const std::shared_ptr<const io::Volume>& volume) {
  studied = volume;
  studying->setValue(0);
  studying->show();
  studies.study(
      volume, [this](double done) { studying->setValue(static_cast<int>(100 * done)); },
      [this, unit = QString::fromStdString(volume->unit)](const auto& study, const std::string& error) {
        studying->hide();
        if (!study) {
          if (!error.empty()) emit model.refused(QString::fromStdString(error));
          return;
        }
        modes::Scene proposed = study->suggested;
        proposed.workspace = model.scene().workspace;
        tissues->set_proposed(proposed);
        curves->set_study(study, unit);
        // What is felt or was edited already is not taken away from under the hand.
        if (edited || touching.live().is_connected()) return;
        proposing = true;
        model.propose(proposed);
        proposing = false;
      });
}

/// What is seen of the volume, as it is shown now.
void PalpatePanel::Parts::read_opacity() {
  if (!scan->source()) return;
  for (const ClinicalView& one : scan->views().views()) {
    if (one.kind != ViewKind::volume) continue;
    if (pqDataRepresentation* const shown = scan->source()->getRepresentation(one.view)) {
      views.set_opacity(opacity_of(*shown->getProxy()));
    }
  }
}

void PalpatePanel::Parts::change_volume(const std::function<void(vtkSMProxy&)>& change) {
  SCOPED_UNDO_EXCLUDE();  // follows from the scene, or from a box that says what it is
  if (!scan->source()) return;
  for (const ClinicalView& one : scan->views().views()) {
    if (one.kind != ViewKind::volume) continue;
    pqDataRepresentation* const shown = scan->source()->getRepresentation(one.view);
    if (!shown) continue;
    change(*shown->getProxy());
    one.view->render();
  }
  read_opacity();
}

/// Where the volume is shown by what is felt, and not as somebody has chosen.
void PalpatePanel::Parts::color_views() {
  if (!look_box->is_felt()) return;
  change_volume([this](vtkSMProxy& volume) { color_volume(volume, model.scene(), low, high); });
}

void PalpatePanel::Parts::draw_contours() {
  contours.set_felt(touching.live().felt_scan(), model.scene(), touching.live().plan());
}

void PalpatePanel::Parts::look(const SessionStatus& seen) {
  SCOPED_UNDO_EXCLUDE();  // what the stylus moves is not what is undone
  // A recording that stands still does not keep the slices from being leafed through.
  const bool moved = seen.connected || std::exchange(followed, seen.frame.index) != seen.frame.index;
  if (seen.connected) touching.keep_off(scan->why_not_felt());
  name_felt();
  if (seen.is_seen() && moved && stylus->slices_follow()) scan->views().show_point(seen.proxy_mm);
  views.show(seen);
}

PalpatePanel::PalpatePanel(QWidget* parent)
    : QDockWidget(tr("Palpate"), parent), parts_(std::make_unique<Parts>(*this)) {
  setObjectName(QStringLiteral("PalpatePanel"));
  setAcceptDrops(true);
  parts_->build();
  QCoreApplication::instance()->installEventFilter(this);
}

PalpatePanel::~PalpatePanel() {
  delete widget();  // the sections lean on the parts
}

/// A folder may be dropped anywhere on the panel.
void PalpatePanel::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls() && event->mimeData()->urls().first().isLocalFile()) event->acceptProposedAction();
}

void PalpatePanel::dropEvent(QDropEvent* event) {
  parts_->scan->open(event->mimeData()->urls().first().toLocalFile().toStdString());
}

bool PalpatePanel::eventFilter(QObject* watched, QEvent* event) {
  const bool pressed = event->type() == QEvent::KeyPress || event->type() == QEvent::ShortcutOverride;
  if (pressed && static_cast<QKeyEvent*>(event)->key() == Qt::Key_Escape) parts_->touching.release();
  // A button that was clicked is done with: the arrow keys are the marked view's again.
  if (event->type() == QEvent::MouseButtonRelease && qobject_cast<QAbstractButton*>(watched) &&
      isAncestorOf(static_cast<QWidget*>(watched))) {
    QTimer::singleShot(0, this, [] { focus_marked_view(); });
  }
  // A number changes only where it was clicked: focus that a hidden button leaves behind is not to come to it.
  if (event->type() == QEvent::Polish && isAncestorOf(qobject_cast<QWidget*>(watched)) &&
      (qobject_cast<QAbstractSpinBox*>(watched) || qobject_cast<QComboBox*>(watched) ||
       qobject_cast<QAbstractSlider*>(watched))) {
    static_cast<QWidget*>(watched)->setFocusPolicy(Qt::ClickFocus);
  }
  // The wheel scrolls the column: a force limit that the pointer happens to pass over is not to change.
  if (event->type() == QEvent::Wheel && isAncestorOf(qobject_cast<QWidget*>(watched)) &&
      (qobject_cast<QAbstractSpinBox*>(watched) || qobject_cast<QComboBox*>(watched)) &&
      !static_cast<QWidget*>(watched)->hasFocus()) {
    event->ignore();
    return true;
  }
  return QDockWidget::eventFilter(watched, event);  // Esc means what it always does, too
}
