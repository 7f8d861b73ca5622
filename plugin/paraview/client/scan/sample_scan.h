#pragma once

/// A scan to try for users who have none: a head from Debian's invesalius-examples, or our own phantom.

#include <QObject>
#include <QProcess>
#include <QString>

namespace palpate::plugin {

class SampleScan : public QObject {
  Q_OBJECT

 public:
  explicit SampleScan(QObject* parent = nullptr);
  /// An unfinished conversion leaves nothing behind.
  ~SampleScan() override;

  /// What is available: "Try the sample head", "Try a phantom". Empty if nothing is, because the program that writes
  /// them (palpate-testdata) is not installed.
  QString offer() const;
  /// Writes it into the user's cache, unless it is already there; then reports that it is ready.
  void make();

 signals:
  void ready(const QString& folder);
  void failed(const QString& why);

 private:
  QString folder() const;
  void finish(bool good);

  QString program_;
  bool has_head_ = false;
  QProcess writing_;
};

}  // namespace palpate::plugin
