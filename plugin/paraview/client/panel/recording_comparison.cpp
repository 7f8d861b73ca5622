#include "plugin/paraview/client/panel/recording_comparison.h"

#include <QVBoxLayout>

#include <string>
#include <utility>
#include <vector>

#include "plugin/paraview/client/panel/chart_picture.h"
#include "plugin/paraview/client/widgets/save_buttons.h"

namespace palpate::plugin {
namespace {

constexpr int compared_pixels = 130;

}  // namespace

RecordingComparison::RecordingComparison(QWidget* parent) : QWidget(parent) {
  auto* const column = new QVBoxLayout(this);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(2);
  chart_ = new ChartPicture(compared_pixels, this);
  chart_->setObjectName(QStringLiteral("palpateComparisonChart"));
  column->addWidget(chart_);
  add_save_buttons(
      *column, *this, QStringLiteral("Comparison"),
      [this](bool table) -> std::function<void(const std::string&)> {
        return [both = both_, first = first_.toStdString(), second = second_.toStdString(),
                table](const std::string& file) {
          table ? write_csv(*both, file) : write_png(charts_of(*both, first, second), file);
        };
      },
      [this](const QString& problem) { emit told(problem, true); });
  hide();
}

void RecordingComparison::compare(const Recording& first, const Recording& second) {
  job_.cancel();
  both_.reset();
  hide();
  if (!first.session || !second.session) return;
  first_ = first.name;
  second_ = second.name;
  job_.ask([a = first.session, b = second.session] { return compare_strokes(*a, *b); },
           [this](const auto& both, const QString& error) { both ? show_both(both) : emit told(error, true); });
}

void RecordingComparison::show_both(std::shared_ptr<const Comparison> both) {
  both_ = std::move(both);
  show();
  std::vector<Chart> charts = charts_of(*both_, first_.toStdString(), second_.toStdString());
  charts.pop_back();  // how far the ways are apart is told in words
  chart_->show_charts(std::move(charts), both_->along_mm.back());
  emit told(tr("Blue: %1, orange: %2. %3").arg(first_, second_, QString::fromStdString(in_words(*both_))), false);
}

}  // namespace palpate::plugin
