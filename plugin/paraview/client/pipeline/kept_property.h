#pragma once

#include <QString>

#include <string>

class pqPipelineSource;

namespace palpate::plugin {

/// Sets a text property of a source, for traces and state files. Makes one undo step, named `what` in ParaView's menu;
/// none if `what` is empty.
void keep_text(pqPipelineSource& source, const char* property, const std::string& text, const QString& what);

/// The same without trace and step.
void put_text(pqPipelineSource& source, const char* property, const std::string& text);

std::string kept_text_of(pqPipelineSource& source, const char* property);

}  // namespace palpate::plugin
