#include "plugin/paraview/client/scan/sample_scan.h"

#include <dlfcn.h>

#include <QCoreApplication>
#include <QDir>
#include <QFileInfo>
#include <QStandardPaths>
#include <QStringList>

#include <exception>

#include "plugin/app/archive_settings.h"
#include "plugin/messages/messages.h"
#include "plugin/paraview/client/words.h"

namespace palpate::plugin {
namespace {

constexpr const char* writer = "palpate-testdata";

/// In a bin folder above the plug-in, as it is built or installed; else where programs are.
QString find_writer() {
  Dl_info info{};
  if (dladdr(reinterpret_cast<const void*>(&find_writer), &info) != 0 && info.dli_fname != nullptr) {
    QDir at = QFileInfo(QString::fromLocal8Bit(info.dli_fname)).absoluteDir();
    do {
      const QFileInfo file(at.filePath(QStringLiteral("bin/") + QLatin1String(writer)));
      if (file.isExecutable() && file.isFile()) return file.absoluteFilePath();
    } while (at.cdUp());
  }
  return QStandardPaths::findExecutable(QLatin1String(writer));
}

}  // namespace

SampleScan::SampleScan(QObject* parent) : QObject(parent), program_(find_writer()) {
  has_head_ = QFileInfo::exists(QStringLiteral("/usr/share/doc/invesalius-examples/examples/Cranium.inv3"));
  connect(&writing_, QOverload<int, QProcess::ExitStatus>::of(&QProcess::finished), this,
          [this](int code, QProcess::ExitStatus status) { finish(status == QProcess::NormalExit && code == 0); });
  connect(&writing_, &QProcess::errorOccurred, this, [this](QProcess::ProcessError error) {
    if (error == QProcess::FailedToStart) finish(false);
  });
}

SampleScan::~SampleScan() {
  writing_.disconnect(this);
  if (writing_.state() == QProcess::NotRunning) return;
  writing_.kill();
  writing_.waitForFinished();
  QDir(folder() + QStringLiteral(".new")).removeRecursively();
}

QString SampleScan::offer() const {
  if (program_.isEmpty()) return {};
  return has_head_ ? tr("Try the sample head") : tr("Try a phantom");
}

QString SampleScan::folder() const {
  const auto cache = QString::fromStdString(user_folder("XDG_CACHE_HOME", ".cache").string());
  return cache + (has_head_ ? QStringLiteral("/sample-head") : QStringLiteral("/sample-phantom"));
}

void SampleScan::make() {
  if (program_.isEmpty() || writing_.state() != QProcess::NotRunning) return;
  try {
    const QString there = folder();
    if (QFileInfo::exists(there)) {
      emit ready(there);
      return;
    }
    const QString next = there + QStringLiteral(".new");
    QDir(next).removeRecursively();
    QDir().mkpath(QFileInfo(there).path());
    const QStringList what = has_head_ ? QStringList{QStringLiteral("invesalius")}
                                       : QStringList{QStringLiteral("phantom"), QStringLiteral("sphere"),
                                                     QStringLiteral("--radius"), QStringLiteral("25")};
    writing_.start(program_, what + QStringList{QStringLiteral("-o"), next});
  } catch (const std::exception& error) {
    emit failed(QString::fromUtf8(error.what()));
  }
}

void SampleScan::finish(bool good) {
  const QString there = folder(), next = there + QStringLiteral(".new");
  if (good && QDir().rename(next, there)) {
    emit ready(there);
    return;
  }
  QDir(next).removeRecursively();
  const QString said = QString::fromUtf8(writing_.readAllStandardError()).trimmed();
  emit failed(words(say("sample-cannot-be-written", there.toStdString(),
                        (said.isEmpty() ? writing_.errorString() : said).toStdString())));
}

}  // namespace palpate::plugin
