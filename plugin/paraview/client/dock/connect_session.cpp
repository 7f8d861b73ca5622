#include <pqUndoStack.h>

#include <QCoreApplication>

#include <cstdint>
#include <glm/common.hpp>
#include <glm/vector_relational.hpp>
#include <optional>
#include <utility>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/dock/parts.h"
#include "plugin/paraview/client/panel/curves_section.h"
#include "plugin/paraview/client/panel/footer.h"
#include "plugin/paraview/client/panel/modes_section.h"
#include "plugin/paraview/client/panel/recordings_section.h"
#include "plugin/paraview/client/panel/tissues_section.h"
#include "plugin/paraview/client/scan/filter_row.h"
#include "plugin/paraview/client/scan/scan_section.h"
#include "plugin/paraview/client/stylus/start_place.h"
#include "plugin/paraview/client/stylus/stylus_section.h"
#include "plugin/paraview/client/widgets/fold.h"
#include "plugin/paraview/client/words.h"

// Connections for connecting, using and disconnecting a stylus.

namespace palpate::plugin {

void PanelParts::connect_session() {
  QObject::connect(column->stylus, &StylusSection::stylus_wanted, &dock, [this] {
    SCOPED_UNDO_EXCLUDE();
    if (session.last().is_seen()) readers.views().show_point(session.last().proxy_mm);
  });
  readers.views().set_leafed([this] { column->stylus->pause_following(); });
  session.set_start([this](const device::Specification& device) { return start_of(device); });
  QObject::connect(&session, &SessionController::recorded, column->recordings, [this](const QString& file) {
    column->recordings_fold->set_open(true);
    column->recordings->open(file);
  });
  QObject::connect(&sharing, &SharingModel::folder_wanted, &dock,
                   [this](const QString& folder) { column->scan->open(folder.toStdString()); });
  QObject::connect(&session, &SessionController::polled, &dock,
                   [this, followed = std::uint64_t{0}](const SessionStatus& seen) mutable {
                     // A paused recording must not prevent browsing the slices.
                     const bool moved = seen.connected || std::exchange(followed, seen.tick.index) != seen.tick.index;
                     if (!layers.is_paused()) follow_stylus(seen, moved);
                   });
  QObject::connect(&session, &SessionController::felt_scan_changed, &dock, [this] { layers.draw_boundaries(); });
  QObject::connect(&session, &SessionController::connection_changed, &dock, [this] {
    column->modes->refresh();
    servers.be_attentive(session.live().is_connected());
  });
  // The session ends before ParaView goes, and before a server takes the views away.
  QObject::connect(QCoreApplication::instance(), &QCoreApplication::aboutToQuit, &dock, [this] {
    QObject::disconnect(&session, &SessionController::recorded, column->recordings,
                        nullptr);  // nobody looks at it any more
    sharing.turn_off();
    session.disconnect_stylus();
  });
}

void PanelParts::follow_stylus(const SessionStatus& seen, bool moved) {
  SCOPED_UNDO_EXCLUDE();  // what the stylus moves is not what is undone
  if (seen.connected) session.keep_off(scans.why_not_felt());
  name_felt();
  if (seen.is_seen() && moved && column->stylus->slices_follow()) {
    const auto& held = correction.held_in();  // its view shows it, wherever the stylus is
    readers.views().show_point(seen.proxy_mm, held ? std::optional(held->normal) : std::nullopt);
  }
  if (seen.connected && !seen.held.empty()) {
    column->curves->profile().touch_at(seen.proxy_mm, seen.probe_mm - seen.proxy_mm);
  }
  layers.draw_stylus();
}

/// Shows the scan, frame and scene of the stylus, whatever the views show.
void PanelParts::name_felt() {
  if (!scans.shown()) {
    const auto coming = scans.on_its_way();
    column->footer->set_felt(coming ? tr("Opening %1…").arg(coming->label) : tr("No scan is open."), false);
    return;
  }
  const ScanHandle& handle = *scans.shown();
  const QStringList others = readers.others_shown();
  const QString through = column->filter->in_words();
  const QString felt =
      (session.last().feels ? tr("Felt: %1. Scene: %2.") : tr("Open: %1. Scene: %2."))
          .arg(through.isEmpty() ? handle.in_words() : handle.in_words() + QStringLiteral(", ") + through,
               column->tissues->scene_in_words());
  const QString beside = tr("Also shown, not felt: %1.").arg(others.join(QStringLiteral(", ")));
  column->footer->set_felt(others.isEmpty() ? felt : felt + QLatin1Char(' ') + beside, true);
}

/// In sight, in reach and outside of anything felt.
glm::dvec3 PanelParts::start_of(const device::Specification& of) {
  const LiveSession& live = session.live();
  const auto plan = live.plan();
  const auto& volume = live.felt_scan();
  const auto in_reach = [&](const glm::dvec3& place) {
    constexpr double margin = 0.95;
    const glm::dvec3 at = glm::abs(plan->workspace.to_device(place));
    return glm::all(glm::lessThan(at, margin * of.workspace_half_extent));
  };
  const StartPlace start = find_start_place(
      volume, *plan, live.scene().gradient_scale_mm.value_or(io::default_gradient_scale_mm(volume->geometry)), in_reach,
      [this](const glm::dvec3& place) { return layers.stylus.shows(place); });
  if (!start.outside) {
    QMetaObject::invokeMethod(
        &dock, [this] { emit session.told(words(say("no-place-outside-the-patient")), true); }, Qt::QueuedConnection);
  }
  return start.place_mm;
}

}  // namespace palpate::plugin
