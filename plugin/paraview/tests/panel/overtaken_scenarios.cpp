// What is opened while a scan is shown or is being made ready: a folder without a scan, and another scan.

#include <pqApplicationCore.h>
#include <pqDeleteReaction.h>
#include <pqObjectBuilder.h>
#include <pqPipelineSource.h>
#include <pqUndoStack.h>
#include <vtkSMPropertyHelper.h>

#include <QListWidget>
#include <QPushButton>
#include <QToolButton>

#include <string>

#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

std::string series_in_pipeline() {
  return vtkSMPropertyHelper(reader().getProxy(), "SeriesUid").GetAsString();
}

/// A folder without a scan is dropped while one is shown: what the panel says of the scan, and what views show, agree.
void a_folder_without_a_scan_takes_nothing_away() {
  feel();
  const QString felt = label("palpateFelt");
  drop_folder(qEnvironmentVariable("PALPATE_DROP"));
  wait_for("it is said that there is none", [] { return label("palpateMessage").startsWith("No image series"); });
  let_go();
  expect_four_views_of_one_scan();
  expect(label("palpateFelt") == felt, "the scan is still named: " + label("palpateFelt").toStdString());
  expect(find<QPushButton>("palpateConnect").text() == "Disconnect", "the stylus is still connected");
  save_screen("junk-dropped");
  press();
}

/// Clicks on a row of the list of series, and returns while its views are being made: the reader that they are of.
unsigned half_shown(int row) {
  const unsigned before = reader_in_pipeline();
  auto& series = find<QListWidget>("palpateSeries");
  click(*series.viewport(), series.visualItemRect(series.item(row)).center());
  wait_for("its first views are made", [before] {
    return reader_in_pipeline() != 0 && reader_in_pipeline() != before && views_open() >= 2 &&
           find<QWidget>("palpateCover").isVisible();
  });
  expect(find<QToolButton>("palpateScanSectionFold").text().contains("Opening"), "it is said whose scan is coming");
  return reader_in_pipeline();
}

/// A scan's views are made one after the other. Between two of them another scan may be chosen, or the scan deleted.
void a_scan_is_overtaken() {
  choose_series(1);
  const std::string second = series_in_pipeline();
  click("palpateScanSectionFold");
  is_laid_out(*find<QListWidget>("palpateSeries").viewport());
  const unsigned overtaken = half_shown(0);
  auto& series = find<QListWidget>("palpateSeries");
  click(*series.viewport(), series.visualItemRect(series.item(1)).center());
  another_scan_is_shown(overtaken);
  expect(series_in_pipeline() == second, "the one that was chosen last is shown");
  expect_four_views_of_one_scan();

  click("palpateScanSectionFold");
  is_laid_out(*series.viewport());
  (void)half_shown(0);
  pqApplicationCore::instance()->getObjectBuilder()->destroy(&reader());
  wait_for("it is said that it is gone",
           [] { return label("palpateMessage") == "the scan was deleted. Open a scan, then press Feel"; });
  expect(views_open() == 0, "none of its views is left");
  expect(!find<QWidget>("palpateCover").isVisible(), "nothing waits for them");
  choose_series(1);
  expect_four_views_of_one_scan();

  // Undo, while the next scan's views are made, does not bring the deleted scan back beside it.
  click("palpateScanSectionFold");
  is_laid_out(*series.viewport());
  pqDeleteReaction::deleteSources({&reader()});
  wait_for(
      "the scan is gone", [] { return label("palpateFelt") == "No scan is open."; }, 20);
  (void)half_shown(0);
  pqUndoStack& undo = *pqApplicationCore::instance()->getUndoStack();
  if (undo.canUndo()) undo.undo();
  scan_is_shown();
  expect_four_views_of_one_scan();
  connect_stylus();
}

}  // namespace

const Scenarios& overtaken_scenarios() {
  static const Scenarios scenarios{
      {"a_folder_without_a_scan_takes_nothing_away", a_folder_without_a_scan_takes_nothing_away},
      {"a_scan_is_overtaken", a_scan_is_overtaken}};
  return scenarios;
}
