#include "plugin/paraview/client/layout/empty_center.h"

#include <pqApplicationCore.h>
#include <pqPipelineSource.h>
#include <pqServerManagerModel.h>
#include <pqTabbedMultiViewWidget.h>
#include <vtkSMProxy.h>

#include <QLayout>
#include <QMainWindow>

#include <algorithm>
#include <string>

namespace palpate::plugin {
namespace {

/// A scene alone shows nothing.
bool is_something_to_see(const pqPipelineSource* source) {
  return source->getProxy()->GetXMLName() != std::string("PalpateScene");
}

}  // namespace

EmptyCenter::EmptyCenter(QMainWindow& window, QWidget& page, QObject* parent)
    : QObject(parent), views_(window.findChild<pqTabbedMultiViewWidget*>()), page_(&page) {
  page.hide();
  if (!views_ || !views_->parentWidget() || !views_->parentWidget()->layout()) {
    views_.clear();
    return;
  }
  page.setParent(views_->parentWidget());
  pqServerManagerModel& model = *pqApplicationCore::instance()->getServerManagerModel();
  constexpr int soon_ms = 150;
  soon_.setSingleShot(true);
  soon_.setInterval(soon_ms);
  connect(&soon_, &QTimer::timeout, this, [this] { refresh(); });
  connect(&model, &pqServerManagerModel::sourceAdded, this, [this] { refresh(); });
  connect(&model, &pqServerManagerModel::sourceRemoved, this, [this] { soon_.start(); });
}

void EmptyCenter::set_advanced(bool advanced) {
  advanced_ = advanced;
  refresh();
}

void EmptyCenter::refresh() {
  if (!views_ || !page_) return;
  const auto sources = pqApplicationCore::instance()->getServerManagerModel()->findItems<pqPipelineSource*>();
  const bool empty = !advanced_ && std::ranges::none_of(sources, is_something_to_see);
  if (empty == page_->isVisibleTo(page_->parentWidget())) return;
  QWidget* const shown = empty ? page_ : views_;
  QWidget* const hidden = empty ? views_ : page_;
  delete views_->parentWidget()->layout()->replaceWidget(hidden, shown, Qt::FindDirectChildrenOnly);
  hidden->hide();
  shown->show();
}

}  // namespace palpate::plugin
