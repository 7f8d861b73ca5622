#include "plugin/paraview/client/model/sharing_model.h"

#include <exception>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>

#include "plugin/messages/messages.h"
#include "plugin/openigtlink/contents.h"
#include "plugin/openigtlink/marks.h"
#include "plugin/openigtlink/names.h"

namespace palpate::plugin {
namespace {

constexpr int between_looks_ms = 20;

igtl::Point point_of(const FeltMark& mark) {
  return {.name = mark.name,
          .group = mark.boundary,
          .position = igtl::ras_of(mark.position_mm),
          .diameter = igtl::mark_diameter_mm,
          .owner = igtl::program_name};
}

/// A place that was not felt.
FeltMark mark_of(const igtl::Point& point) {
  FeltMark mark;
  mark.name = point.name;
  mark.position_mm = igtl::lps_of(point.position);
  mark.value = std::numeric_limits<double>::quiet_NaN();
  return mark;
}

std::vector<igtl::Point> points_of(const Marks& marks) {
  std::vector<igtl::Point> points;
  for (const FeltMark& mark : marks.points) points.push_back(point_of(mark));
  return points;
}

}  // namespace

SharingModel::SharingModel(SessionController& session, SceneModel& scene, MarksModel& marks, QObject* parent)
    : QObject(parent), session_(session), scene_(scene), marks_(marks) {
  looks_.setInterval(between_looks_ms);
  connect(&looks_, &QTimer::timeout, this, [this] { look(); });
  connect(&marks, &MarksModel::changed, this, [this] { send_marks(); });
}

QString SharingModel::turn_on(int port) {
  try {
    server_ = std::make_unique<igtl::Server>(igtl::Address{.port = port});
  } catch (const std::exception& error) {
    return QString::fromUtf8(error.what());
  }
  igtl::Changes changes{
      .set_scene = [this](const auto& scene, const auto& prepared) { take_scene(scene, prepared); },
      .set_scan = {},
      .set_marks = [this](const auto& points) { take_marks(points); },
      .load = {},
      .open = [this](const std::string& folder) { emit folder_wanted(QString::fromStdString(folder)); },
      .is_settled = [this] { return scene_.is_settled(); }};
  if (!received_) received_.emplace();
  sharing_ = std::make_unique<igtl::Sharing>(session_.live(), *server_, *received_, threads_, std::move(changes),
                                             igtl::Announcer::MakesMarks::no);
  send_marks();
  looks_.start();
  emit changed();
  return {};
}

void SharingModel::turn_off() {
  looks_.stop();
  sharing_.reset();
  server_.reset();
  clients_ = 0;
  emit changed();
}

void SharingModel::look() {
  sharing_->look();
  const std::size_t clients = server_->counts().clients;
  if (std::exchange(clients_, clients) != clients) emit changed();
}

void SharingModel::send_marks() {
  if (!sharing_) return;
  sharing_->set_marks(points_of(marks_.marks()));
}

void SharingModel::take_scene(const modes::Scene& scene, const PreparedScene& prepared) {
  if (session_.expects_scan()) throw Refusal(say("scan-is-still-being-read"));  // made on the previous scan
  session_.offer(prepared);
  const auto refused = std::make_shared<QString>();
  const auto has_waited = std::make_shared<bool>(false);
  const modes::Scene& latest = scene_.latest();
  // An earlier scene that is shown may have looser limits than the user's.
  const modes::Scene wanted =
      scene_.shows_before() ? igtl::tightened(scene, latest.limits, latest.stiffness_n_per_m) : scene;
  const auto change = [wanted, has_waited](modes::Scene& now) {
    // A limit that was lowered meanwhile stays.
    now = *has_waited ? igtl::tightened(wanted, now.limits, now.stiffness_n_per_m) : wanted;
  };
  scene_.edit(tr("Scene from 3D Slicer"), change, [refused](const QString& why) { *refused = why; });
  *has_waited = true;
  if (!refused->isEmpty()) throw std::runtime_error(refused->toStdString());
}

void SharingModel::take_marks(const std::vector<igtl::Point>& points) {
  igtl::internal::check_scan(marks_.has_scan());
  const std::vector<igtl::ChangedMark> changed = igtl::changed_marks(points_of(marks_.marks()), points);
  if (changed.empty()) return;
  marks_.edit(tr("Marks from 3D Slicer"), [&](Marks& now) {
    for (const auto& [at, mark] : changed) {
      (at < now.points.size() ? now.points[at] : now.points.emplace_back()) = mark_of(mark);
    }
  });
}

}  // namespace palpate::plugin
