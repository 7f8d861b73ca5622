#pragma once

/// Texts of the models that ParaView's pipeline keeps, so that its undo, state files and traces hold every edit.

#include <QObject>
#include <QString>

#include <string>

namespace palpate::plugin {

class KeptText : public QObject {
  Q_OBJECT

 public:
  using QObject::QObject;

  /// Whether there is a place for them.
  virtual bool is_open() const = 0;
  /// Makes a place that holds this scene; opened() follows. Does nothing if ParaView has no session.
  virtual void open(const std::string& scene) = 0;

  /// Empty if there is none.
  virtual std::string text(const char* key) const = 0;
  /// One step that can be undone, which ParaView's menu names `what`; where that is empty, none.
  virtual void keep(const char* key, const std::string& text, const QString& what) = 0;
  /// The same without a trace and without a step.
  virtual void put(const char* key, const std::string& text) = 0;

  virtual bool can_undo() const = 0;
  virtual void undo() = 0;
  virtual void redo() = 0;
  /// Edits made so far can no longer be undone here.
  virtual void forget_steps() = 0;

 signals:
  /// The texts are in another place from now on.
  void opened();
  /// A text may be another one, whoever has changed it: undo, a trace, the property panel, a state file.
  void changed();
};

}  // namespace palpate::plugin
