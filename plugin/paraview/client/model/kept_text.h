#pragma once

/// Texts of the models, kept in ParaView's pipeline so that its undo, state files and traces hold every edit.

#include <QObject>
#include <QString>

#include <string>

namespace palpate::plugin {

class KeptText : public QObject {
  Q_OBJECT

 public:
  using QObject::QObject;

  /// Whether the pipeline has a place for the texts.
  virtual bool is_open() const = 0;
  /// Makes a place with this scene; opened() follows. Does nothing if ParaView has no session.
  virtual void open(const std::string& scene) = 0;

  /// Empty if there is none.
  virtual std::string text(const char* key) const = 0;
  /// As one step that can be undone, named `what` in ParaView's menu; if `what` is empty, without a step.
  virtual void keep(const char* key, const std::string& text, const QString& what) = 0;
  /// The same without trace and step.
  virtual void put(const char* key, const std::string& text) = 0;

  virtual bool can_undo() const = 0;
  virtual void undo() = 0;
  virtual void redo() = 0;
  /// Edits made so far can no longer be undone here.
  virtual void forget_steps() = 0;

 signals:
  /// From now on the texts are kept in another place.
  void opened();
  /// A text may have changed, by undo, a trace, the property panel or a state file.
  void changed();
};

}  // namespace palpate::plugin
