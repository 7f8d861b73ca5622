#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqCoreUtilities.h>
#include <pqObjectBuilder.h>
#include <pqServer.h>
#include <pqServerResource.h>

#include <QApplication>
#include <QCheckBox>
#include <QDialog>
#include <QDockWidget>
#include <QFile>
#include <QLabel>
#include <QLineEdit>
#include <QListWidget>
#include <QMessageBox>
#include <QProgressBar>
#include <QPushButton>
#include <QSlider>
#include <QTimer>
#include <QToolButton>
#include <QTreeWidget>
#include <QtTest/QTest>

#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstdlib>

#include "plugin/paraview/tests/panel/correct_steps.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

// With a separate server on loopback: PALPATE_SERVER is its port, PALPATE_SERVER_PID its process, PALPATE_REMOTE the
// folder to open, by the server's own name.

namespace {

pqServer* active_server() {
  return pqActiveObjects::instance().activeServer();
}

void connect_server() {
  wait_for("ParaView is ready", [] { return active_server() != nullptr; });
  wait_ms(3000);  // ParaView still makes its own server, and must not be held up in that
  const QString port = qEnvironmentVariable("PALPATE_SERVER");
  pqApplicationCore::instance()->getObjectBuilder()->createServer(
      pqServerResource(QStringLiteral("cs://127.0.0.1:") + port));
  wait_for("ParaView is connected to the server", [] { return active_server() && active_server()->isRemote(); });
  wait_ms(1000);
}

/// What a user does in the file dialog that a click opens.
void choose(const char* button, const QString& path) {
  bool chosen = false;
  QTimer looking;
  QObject::connect(&looking, &QTimer::timeout, [&] {
    auto* const dialog = qobject_cast<QDialog*>(QApplication::activeModalWidget());
    auto* const name = dialog ? qobject_cast<QLineEdit*>(dialog->focusWidget()) : nullptr;  // it begins with the name
    if (!name || !name->isVisible()) return;
    looking.stop();
    name->setText(path);
    chosen = true;
    wait_ms(500);
    if (dialog->isVisible()) QTest::keyClick(name, Qt::Key_Return);
    for (int n = 0; n < 10 && dialog->isVisible(); ++n) {  // a folder is gone into first
      wait_ms(1000);
      for (auto* const ok : dialog->findChildren<QPushButton*>()) {
        const bool accepts = ok->isDefault() || ok->text().remove(QLatin1Char('&')) == QLatin1String("OK");
        if (dialog->isVisible() && ok->isVisible() && accepts) ok->click();
      }
    }
  });
  constexpr int poll_ms = 300;
  looking.start(poll_ms);
  click(button);
  expect(chosen, std::string("a file dialog was opened by ") + button);
}

void open_folder() {
  if (!find<QPushButton>("palpateOpen").isVisible()) click("palpateScanSectionFold");
  choose("palpateOpen", qEnvironmentVariable("PALPATE_REMOTE"));
}

void record() {
  choose("palpateRecord", qEnvironmentVariable("PALPATE_RECORDING"));
  wait_for("it records", [] { return find<QPushButton>("palpateRecord").text() == "Stop recording"; });
  stylus_rests();  // the session began anew: the hand goes to its place
}

void feel_remotely(bool recorded) {
  scan_is_shown();
  find<QCheckBox>("palpateFollow").setChecked(false);  // each slice is a question to the server
  connect_stylus();
  find<QToolButton>("palpateGoToStylus").click();  // where the mouse can take it
  views_rest();
  if (recorded) record();
  press();
}

void wait_for_word(const char* word) {
  wait_for(std::string("the panel says: ") + word, [&] { return label("palpateMessage").contains(word); });
}

/// Felt from the copy on this machine; then ParaView leaves the server, and is used without one.
void remote_probe() {
  connect_server();
  open_folder();
  wait_for_word("Felt from the copy on this machine, which is the same as the server's.");
  feel_remotely(true);
  save_screen("remote");
  pqApplicationCore::instance()->getObjectBuilder()->removeServer(active_server());
  wait_for(
      "nothing is held", [] { return label("palpateState").startsWith("Off"); }, 20);
  expect(number("palpateForce") == 0, "the force was taken away");
  expect(label("palpateStylusMessage")
             .contains("ParaView left the server: the stylus was let go, and a recording closed."),
         "it is said why");
  expect(QFile::exists(qEnvironmentVariable("PALPATE_RECORDING")), "the recording is there");
  let_go();
  wait_for("ParaView has its built-in server again", [] { return active_server() && !active_server()->isRemote(); });
  wait_ms(1000);
  open_folder();
  feel_remotely(false);
}

/// What was not fetched cannot be felt, and it is said why; then it is.
void remote_fetched() {
  connect_server();
  auto& progress = find<QProgressBar>("palpateProgress");
  const auto cancelling = QObject::connect(&progress, &QProgressBar::valueChanged, [&] {
    if (progress.format().startsWith("Fetching")) find<QPushButton>("palpateCancel").click();
  });
  open_folder();
  wait_for_word("Cancelled.");
  QObject::disconnect(cancelling);
  wait_for(
      "connecting can be tried", [] { return find<QPushButton>("palpateConnect").isEnabled(); }, 20);
  click("palpateConnect");
  expect(label("palpateStylusMessage")
             .contains(
                 "The scan is on the server, and was not fetched: choose it again in the list, or name a copy here."),
         "connecting is refused with the reason");
  expect(find<QPushButton>("palpateConnect").text() == "Connect", "nothing is connected");
  auto& series = find<QListWidget>("palpateSeries");
  click(*series.viewport(), series.visualItemRect(series.item(0)).center());
  wait_for_word("Fetched from the server.");
  feel_remotely(true);
  click("palpateRecord");
  wait_for(
      "the recording is closed",
      [] {
        const QString said = label("palpateStylusMessage");
        return said.startsWith("Recorded: ") && said.endsWith(" ticks, 0 lost.");
      },
      20);
  let_go();
}

/// Saved, and loaded where nothing is left of it: the scan comes back, and the scene.
void state_is_loaded_again() {
  const std::string saved = scene_text();
  const QString file = qEnvironmentVariable("PALPATE_PICTURES") + QStringLiteral("/panel-remote.pvsm");
  pqApplicationCore& core = *pqApplicationCore::instance();
  expect(core.saveState(file), "the state is saved");
  core.getObjectBuilder()->resetServer(active_server());
  wait_for(
      "nothing is left to feel", [] { return !find<QPushButton>("palpateConnect").isEnabled(); }, 20);
  core.loadState(file.toUtf8().constData(), active_server());
  scan_is_shown();
  expect(scene_text() == saved, "the scene is the same text");
}

/// A folder of this machine has the same name and series, and other voxels; and a state brings it all back.
void remote_different() {
  connect_server();
  open_folder();
  wait_for_word(
      "The copy on this machine differs from the server's scan in values or places: the scan was fetched from the "
      "server.");
  feel_remotely(true);
  click("palpateRecord");
  wait_for(
      "the recording is closed", [] { return label("palpateStylusMessage").startsWith("Recorded"); }, 20);
  let_go();
  click("palpateConnect");
  state_is_loaded_again();
  wait_for_word(
      "The copy on this machine differs from the server's scan in values or places: the scan was fetched from the "
      "server.");
  feel_remotely(false);
}

/// The server is killed in mid-contact. ParaView then asks whether to save its state, and ends itself with _exit(-1).
void remote_killed() {
  connect_server();
  open_folder();
  wait_for_word("Felt from the copy on this machine, which is the same as the server's.");
  feel_remotely(true);
  QTimer looking;
  QObject::connect(&looking, &QTimer::timeout, [&] {
    auto* const asks = qobject_cast<QMessageBox*>(QApplication::activeModalWidget());
    if (!asks) return;
    looking.stop();
    // At once: the panel is told before ParaView is.
    const bool zero = number("palpateForce") == 0 && label("palpateState").startsWith("Off");
    const QString words = label("palpateStylusMessage");
    const bool said = words.contains(
        "The server is lost: the force was taken away, and a recording closed. ParaView cannot go on without "
        "its server: it asks whether to save the state, and ends.");
    wait_ms(300);  // painted
    save_screen("remote-lost");
    std::printf("remote_killed: %s\n", !zero   ? "FAILED: the force is on"
                                       : !said ? "FAILED: it is not said why"
                                               : "passed");
    if (!said)
      std::printf("remote_killed: said: %s; state: %s\n", qPrintable(words), qPrintable(label("palpateState")));
    std::printf("remote_killed: ParaView asks: %s\n", qPrintable(asks->text().simplified()));
    std::fflush(stdout);
    asks->button(QMessageBox::No) ? asks->button(QMessageBox::No)->click() : asks->buttons().last()->click();
  });
  constexpr int poll_ms = 50;
  looking.start(poll_ms);
  ::kill(qEnvironmentVariableIntValue("PALPATE_SERVER_PID"), SIGKILL);
  wait_for(
      "ParaView ends", [] { return false; }, 60);
}

/// What is to be known of a scan stands in the panel; ParaView's window of messages stays away.
void remote_noted() {
  connect_server();
  open_folder();
  wait_for_word("Fetched from the server.");
  wait_ms(1000);
  save_screen("remote-noted");
  expect(label("palpateMessage").contains("lices"), "the panel has the note: " + label("palpateMessage").toStdString());
  for (auto* const dock : pqCoreUtilities::mainWidget()->findChildren<QDockWidget*>()) {
    expect(!dock->isVisible() || dock->objectName() == "PalpatePanel",
           "no other window comes up: " + dock->objectName().toStdString());
  }
}

/// The frame that is shown is fetched, and felt: the recording names both, and repeats() has them of the server's
/// files.
void remote_frames() {
  connect_server();
  open_folder();
  wait_for_word("Fetched from the server.");
  scan_is_shown();
  auto& slider = find<QSlider>("palpateFrame");
  expect(slider.maximum() == 2, "there are three frames to slide over");
  feel_remotely(true);
  slider.setValue(2);
  wait_for("the last frame is felt", [] { return label("palpateFelt").contains("frame 3 of 3"); });
  wait_ms(1500);
  save_screen("remote-frame");
  click("palpateRecord");
  wait_for(
      "the recording is closed", [] { return label("palpateStylusMessage").startsWith("Recorded"); }, 20);
  let_go();
}

QTreeWidget& structure_list() {
  return find<QTreeWidget>("palpateStructureList");
}

bool is_of_server(const std::string& scene) {
  const std::string there = qEnvironmentVariable("PALPATE_REMOTE").toStdString();
  return scene.find(there + "/liver.dcm") != std::string::npos;
}

/// A state that names a structure of the server brings both back.
void structures_come_back() {
  state_is_loaded_again();
  wait_for(
      "its structures are listed again", [] { return structure_list().topLevelItemCount() == 2; }, 30);
  wait_for(
      "and can be felt", [] { return find<QPushButton>("palpateConnect").isEnabled(); }, 20);
}

constexpr glm::dvec3 beside_the_liver(0, -17, 0.5);  // a ball of 16 mm

/// The server's outline is corrected here: a ball is added to it.
void add_to_the_liver() {
  expect(felt_mm(beside_the_liver) < 0, "it lies outside");
  click("palpateCorrect");
  wait_for("it is being corrected", [] { return find<QWidget>("palpateCorrectBox").isVisible(); });
  scroll_to(find<QWidget>("palpateToolAdd"));
  click("palpateToolAdd");
  views_rest();
  const glm::dvec3 on_slice(0, -17, height_of_slice());
  drag(view("Axial"), pixel_of("Axial", on_slice), pixel_of("Axial", on_slice + glm::dvec3(4, 0, 0)), true);
  wait_for("what was drawn is an edit", [] { return has_edit("add"); });
  wait_for(
      "and felt", [&] { return felt_mm(on_slice) > 1; }, 60);
  expect(std::abs(on_slice.z - beside_the_liver.z) < 1.5, "in the middle of the scan");
  save_screen("remote-corrected");
  scroll_to(find<QWidget>("palpateCorrect"));
  click("palpateCorrect");
  wait_for("it is corrected no longer", [] { return !find<QWidget>("palpateCorrectBox").isVisible(); });
}

/// A segmentation and a label map, whose voxels have a file of their own, lie beside the scan on the server, where no
/// path of this machine leads. They are listed and felt; one of another patient, of this machine, is not. repeats() has
/// the session again of the server's files.
void remote_structures() {
  connect_server();
  open_folder();
  wait_for_word("Fetched from the server.");
  scan_is_shown();
  click("palpateStructuresSectionFold");
  wait_for(
      "the server's structures are listed", [] { return structure_list().topLevelItemCount() == 2; }, 30);
  const bool liver_first = structure_list().topLevelItem(0)->text(0) == "Liver";
  QTreeWidgetItem& liver = *structure_list().topLevelItem(liver_first ? 0 : 1);
  QTreeWidgetItem& box = *structure_list().topLevelItem(liver_first ? 1 : 0);
  expect(liver.text(0) == "Liver" && box.text(0) == "box", "by their names");
  wait_for(
      "they are measured", [&] { return !liver.text(1).isEmpty() && !box.text(1).isEmpty(); }, 20);
  expect(box.text(1) == "6.00 ml", "with its voxels: " + box.text(1).toStdString());
  structure_list().setCurrentItem(&liver);
  scroll_to(find<QWidget>("palpateStructureKeepOut"));
  click("palpateStructureKeepOut");
  wait_for(
      "one press makes a margin to keep out of", [] { return scene_text().find("keep_out") != std::string::npos; }, 20);
  expect(is_of_server(scene_text()), "which names the file as the server does: " + scene_text());
  add_to_the_liver();
  structures_come_back();
  expect(has_edit("add"), "with what was corrected");
  wait_for(
      "which is felt again", [] { return felt_mm(beside_the_liver) > 1; }, 60);
  find<QCheckBox>("palpateFollow").setChecked(false);
  connect_stylus();
  record();
  wait_for(
      "the distance is told",
      [] { return find<QLabel>("palpateDistance").isVisible() && label("palpateDistance").contains("Liver"); }, 20);
  save_screen("remote-structures");
  name_file("palpateAddStructures", qEnvironmentVariable("PALPATE_FOREIGN"));
  wait_for(
      "another patient's is listed, too", [] { return structure_list().topLevelItemCount() == 3; }, 20);
  const QTreeWidgetItem& foreign = *structure_list().topLevelItem(2);
  expect((foreign.flags() & Qt::ItemIsUserCheckable) == 0 && foreign.toolTip(0).contains("outlined on another patient"),
         "and cannot be used, which is said");
  click("palpateRecord");
  wait_for(
      "the recording is closed", [] { return label("palpateStylusMessage").startsWith("Recorded"); }, 20);
  click("palpateConnect");
}

void is_refused(const char* why) {
  connect_server();
  open_folder();
  wait_for("it is said what is wrong", [why] { return label("palpateMessage") == why; });
  expect(!find<QPushButton>("palpateConnect").isEnabled(), "there is nothing to connect to");
}

void remote_without_series() {
  is_refused(
      "The server finds no image series there: choose a folder by its path on the server, which the server can read.");
}

void remote_without_plugin() {
  is_refused("The server has no Palpate plug-in of this version: load Palpate.so there (Tools > Manage Plugins).");
}

}  // namespace

const Scenarios& remote_scenarios() {
  static const Scenarios all{{"remote_probe", remote_probe},
                             {"remote_fetched", remote_fetched},
                             {"remote_different", remote_different},
                             {"remote_killed", remote_killed},
                             {"remote_noted", remote_noted},
                             {"remote_frames", remote_frames},
                             {"remote_structures", remote_structures},
                             {"remote_without_series", remote_without_series},
                             {"remote_without_plugin", remote_without_plugin}};
  return all;
}
