#pragma once

/// A pipeline that keeps texts, with undo.

#include <map>
#include <string>
#include <utility>
#include <vector>

#include "plugin/paraview/client/model/kept_text.h"

namespace palpate::plugin {

class MadeText : public KeptText {
 public:
  bool is_open() const override { return open_; }
  void open(const std::string& scene) override {
    texts = {{"Scene", scene}};
    open_ = true;
    emit opened();
  }
  std::string text(const char* key) const override {
    const auto found = texts.find(key);
    return found == texts.end() ? std::string() : found->second;
  }
  void keep(const char* key, const std::string& text, const QString& what) override {
    if (!what.isEmpty()) {
      steps.resize(at);
      steps.push_back({what, key, texts[key], text});
      ++at;
    }
    put(key, text);
  }
  void put(const char* key, const std::string& text) override {
    texts[key] = text;
    emit changed();
  }
  bool can_undo() const override { return at > 0; }
  void undo() override {
    if (at == 0) return;
    --at;
    put(steps[at].key.c_str(), steps[at].before);
  }
  void redo() override {
    if (at == steps.size()) return;
    ++at;
    put(steps[at - 1].key.c_str(), steps[at - 1].after);
  }
  /// As if its source were deleted in the Pipeline Browser.
  void take_away() {
    texts.clear();
    open_ = false;
  }
  void forget_steps() override {
    steps.clear();
    at = 0;
  }

  struct Step {
    QString what;
    std::string key, before, after;
  };
  std::map<std::string, std::string> texts;
  std::vector<Step> steps;
  std::size_t at = 0;

 private:
  bool open_ = false;
};

}  // namespace palpate::plugin
