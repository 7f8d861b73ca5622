// The panel's session as 3D Slicer would see it: read by a program that shares no code with Palpate.

#include <QCheckBox>
#include <QJsonArray>
#include <QJsonDocument>
#include <QJsonObject>
#include <QLabel>
#include <QProcess>

#include <cmath>

#include "plugin/paraview/client/model/session_controller.h"
#include "plugin/paraview/tests/panel/panel_rig.h"
#include "plugin/paraview/tests/panel/panel_steps.h"

namespace {

/// What came in that time. The panel goes on meanwhile.
QJsonObject read_for(const QString& port, const char* seconds) {
  QProcess reader;
  reader.start(QStringLiteral("python3"), {QStringLiteral("-B"), QString::fromLocal8Bit(qgetenv("PALPATE_IGTL_READER")),
                                           port, QLatin1String(seconds)});
  wait_for(
      "the reader ends", [&] { return reader.state() == QProcess::NotRunning; }, 30);
  const QByteArray said = reader.readAllStandardOutput();
  expect(!said.isEmpty(), "it read something: " + reader.readAllStandardError().toStdString());
  return QJsonDocument::fromJson(said).object();
}

double component(const QJsonObject& said, const char* device, int n) {
  return said["places"].toObject()[QLatin1String(device)].toArray()[n].toDouble();
}

double length(const QJsonObject& said, const char* device) {
  return std::hypot(component(said, device, 0), component(said, device, 1), component(said, device, 2));
}

/// A ball of 25 mm about the origin, touched from outside.
void what_is_shared_is_what_is_felt() {
  scan_is_shown();
  click("palpateSharingSectionFold");
  click("palpateShare");
  const auto told = [] { return find<QLabel>("palpateSharing").text(); };
  wait_for("it says where it listens", [&] { return told().contains(QStringLiteral("127.0.0.1")); });
  const QString port = told().section(QStringLiteral("port "), 1).section(QLatin1Char(':'), 0, 0);
  QJsonObject said = read_for(port, "2");
  expect(said["state"].toString() == QStringLiteral("off") && said["frames"].toInt() == 0,
         "no stylus is connected yet");
  expect(!said["drawn"].toArray().isEmpty(), "the boundaries are seen before they are felt");
  expect(number("palpateForce") == 0, "sharing alone is no force");

  connect_stylus();
  QWidget& coronal = view("Coronal");
  for (int n = 0; n < 60 && number("palpateForce") < 0.3; ++n) {
    step_hand(coronal, "Prior");
    stylus_rests();
  }
  const double shown_n = number("palpateForce");
  expect(shown_n > 0.2, "it is felt");
  said = read_for(port, "2");
  expect(said["state"].toString() == QStringLiteral("feeling"), "it says so");
  expect(said["frames"].toInt() > 60,
         "about sixty frames a second: " + std::to_string(said["frames"].toInt()) + " in 2 s");
  expect(std::abs(length(said, "Force") - shown_n) < 0.02, "the force that is shown: " + std::to_string(shown_n) +
                                                               " N, sent " + std::to_string(length(said, "Force")) +
                                                               " N");
  expect(std::abs(length(said, "Proxy") - 25) < 0.5,
         "the proxy lies on the ball: " + std::to_string(length(said, "Proxy")) + " mm from its center");
  const glm::dvec3 proxy = panel_session().last().proxy_mm;
  expect(std::abs(component(said, "Proxy", 0) + proxy.x) < 0.05 &&
             std::abs(component(said, "Proxy", 1) + proxy.y) < 0.05 &&
             std::abs(component(said, "Proxy", 2) - proxy.z) < 0.05,
         "it is sent in RAS");
  expect(!said["contact"].toObject()["boundary"].toString().isEmpty(), "the boundary is named");
  save_screen("shared");
  click("palpateShare");
  wait_for("it is off", [&] { return told().isEmpty(); });
  expect(number("palpateForce") > 0.2, "and the force stays");
}

}  // namespace

const Scenarios& sharing_scenarios() {
  static const Scenarios scenarios{{"what_is_shared_is_what_is_felt", what_is_shared_is_what_is_felt}};
  return scenarios;
}
