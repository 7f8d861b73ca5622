// Memory left on the heap after rounds of opening, probing and closing, compared with the same rounds without a panel:
// an image of the same size in the same views.

#include <pqActiveObjects.h>
#include <pqApplicationCore.h>
#include <pqObjectBuilder.h>
#include <pqOutputPort.h>
#include <pqPipelineSource.h>
#include <pqRenderView.h>
#include <vtkNew.h>
#include <vtkSMPVRepresentationProxy.h>
#include <vtkSMParaViewPipelineControllerWithRendering.h>
#include <vtkSMPropertyHelper.h>
#include <vtkSMSourceProxy.h>

#include <QFile>
#include <QFileInfo>
#include <QPushButton>

#include <cstdint>
#include <cstdio>
#include <functional>

#include "plugin/bench/heap_use.h"
#include "plugin/paraview/client/views/scalar_coloring.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

/// Live heap after the rounds that PALPATE_ROUNDS names, such as "10,50", each told in a line.
void repeat(const char* name, const std::function<void()>& round) {
  const QStringList told = qEnvironmentVariable("PALPATE_ROUNDS", "3,8").split(QLatin1Char(','));
  for (int n = 1; n <= told.back().toInt(); ++n) {
    round();
    wait_ms(500);
    if (!told.contains(QString::number(n))) continue;
    std::printf("%s: after round %d: %llu bytes\n", name, n,
                static_cast<unsigned long long>(palpate::plugin::live_heap_bytes()));
    std::fflush(stdout);
  }
}

void reset() {
  pqApplicationCore::instance()->getObjectBuilder()->resetServer(pqActiveObjects::instance().activeServer());
  wait_for("a fresh session is there", [] { return pqActiveObjects::instance().activeServer() != nullptr; });
}

void rounds_of_probing() {
  repeat("rounds_of_probing", [] {
    drop_folder(qEnvironmentVariable("PALPATE_DROP"));
    scan_is_shown();
    connect_stylus();
    press_once();
    wait_for("nothing is held", [] { return number("palpateForce") < 0.05; });
    click("palpateConnect");
    reset();
    wait_for("nothing is left to feel", [] { return !find<QPushButton>("palpateConnect").isEnabled(); });
  });
}

void without_the_panel() {
  repeat("without_the_panel", [] {
    pqServer* const server = pqActiveObjects::instance().activeServer();
    pqObjectBuilder& builder = *pqApplicationCore::instance()->getObjectBuilder();
    pqPipelineSource* const source =
        builder.createSource(QStringLiteral("sources"), QStringLiteral("RTAnalyticSource"), server);
    const int extent[6] = {0, 63, 0, 63, 0, 63};  // the panel's phantom
    vtkSMPropertyHelper(source->getProxy(), "WholeExtent").Set(extent, 6);
    source->getProxy()->UpdateVTKObjects();
    source->updatePipeline();
    vtkNew<vtkSMParaViewPipelineControllerWithRendering> controller;
    for (const char* const shown_as : {"Slice", "Slice", "Slice", "Volume"}) {
      auto* const view = qobject_cast<pqRenderView*>(builder.createView(pqRenderView::renderViewType(), server));
      auto* const shown = vtkSMPVRepresentationProxy::SafeDownCast(
          controller->Show(vtkSMSourceProxy::SafeDownCast(source->getProxy()), 0, view->getViewProxy()));
      shown->SetRepresentationType(shown_as);
      palpate::plugin::color_by_points(*shown, "RTData");
      view->resetCamera();
      constexpr int pictures = 20;  // as many as a press takes
      for (int n = 0; n < pictures; ++n) view->forceRender();
    }
    reset();
  });
}

double heap_mib() {
  return static_cast<double>(palpate::plugin::live_heap_bytes()) / (1 << 20);
}

/// A scan of 32 MiB after a small one, which has made what the program makes once.
void a_closed_scan_is_not_held() {
  scan_is_shown();
  reset();
  wait_ms(2000);
  const double before = heap_mib();
  drop_folder(qEnvironmentVariable("PALPATE_DROP"));
  scan_is_shown();
  views_rest();
  const double with_scan = heap_mib();
  expect(with_scan > before + 32, "the scan is in memory");
  reset();
  double after = 0;
  constexpr double most_mib = 24;
  const bool is_back = comes_true([&] {
    after = heap_mib();
    return after < before + most_mib;
  });
  std::printf("a_closed_scan_is_not_held: %.0f MiB of live heap before, %.0f with the scan, %.0f once it is closed\n",
              before, with_scan, after);
  expect(is_back, "its memory is free again");
}

double resident_mib() {
  QFile status(QStringLiteral("/proc/self/status"));
  expect(status.open(QIODevice::ReadOnly), "the system tells what the program holds");
  for (const QByteArray& line : status.readAll().split('\n')) {
    if (line.startsWith("VmRSS:")) return line.simplified().split(' ')[1].toDouble() / 1024;
  }
  return 0;
}

void tell_memory(const char* when) {
  std::printf("memory_of_a_scan: %s: %.0f MiB resident, %.0f MiB of live heap\n", when, resident_mib(), heap_mib());
  std::fflush(stdout);
}

/// A measurement: what the program holds before a scan, with it, and once it is closed; three times. Of several
/// folders, with a colon between them: with each of them, one after the other, and once the last is closed.
void memory_of_a_scan() {
  wait_ms(3000);
  tell_memory("at first");
  const QStringList folders = qEnvironmentVariable("PALPATE_DROP").split(QLatin1Char(':'));
  if (folders.size() > 1) {
    for (const QString& folder : folders) {
      const unsigned before = reader_in_pipeline();
      drop_folder(folder);
      another_scan_is_shown(before);
      wait_ms(5000);
      tell_memory(QFileInfo(folder).fileName().toUtf8().constData());
    }
    reset();
    wait_ms(5000);
    return tell_memory("closed");
  }
  for (int n = 0; n < 3; ++n) {
    drop_folder(qEnvironmentVariable("PALPATE_DROP"));
    scan_is_shown();
    tell_memory("with the scan");
    reset();
    wait_ms(3000);
    tell_memory("closed");
  }
}

}  // namespace

const Scenarios& heap_scenarios() {
  static const Scenarios scenarios{{"rounds_of_probing", rounds_of_probing},
                                   {"without_the_panel", without_the_panel},
                                   {"a_closed_scan_is_not_held", a_closed_scan_is_not_held},
                                   {"memory_of_a_scan", memory_of_a_scan}};
  return scenarios;
}
