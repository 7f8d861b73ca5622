#pragma once

/// The source in ParaView's pipeline (PalpateScene) that keeps the scene and the marks.

#include <pqPipelineSource.h>

#include <QPointer>

#include "plugin/paraview/client/model/kept_text.h"

namespace palpate::plugin {

class SceneSource : public KeptText {
  Q_OBJECT

 public:
  using KeptText::KeptText;

  pqPipelineSource* source() const { return source_; }
  /// Takes over a source of the pipeline, restored by a state file or by Undo; null: the file has none. The previous
  /// source is removed.
  void replace(pqPipelineSource* source);

  bool is_open() const override { return source_ != nullptr; }
  void open(const std::string& scene) override;
  std::string text(const char* key) const override;
  void keep(const char* key, const std::string& text, const QString& what) override;
  void put(const char* key, const std::string& text) override;
  bool can_undo() const override;
  void undo() override;
  void redo() override;
  void forget_steps() override;

 private:
  void adopt(pqPipelineSource& source);

  QPointer<pqPipelineSource> source_;
};

}  // namespace palpate::plugin
