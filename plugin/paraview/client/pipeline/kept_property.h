#pragma once

#include <QString>

#include <string>

class pqPipelineSource;

namespace palpate::plugin {

/// Sets a text property of a source, for traces and state files. One step that can be undone, which ParaView's menu
/// names `what`; where that is empty, none.
void keep_text(pqPipelineSource& source, const char* property, const std::string& text, const QString& what);

/// Sets it without a trace and without a step.
void put_text(pqPipelineSource& source, const char* property, const std::string& text);

std::string kept_text_of(pqPipelineSource& source, const char* property);

}  // namespace palpate::plugin
