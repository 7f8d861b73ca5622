#pragma once

/// Unsaved work in words, and the question whether to save or discard it.

#include <QString>
#include <QWidget>

#include "plugin/paraview/client/model/unsaved_work.h"

namespace palpate::plugin {

/// "the edited scene, the corrected outline of Liver, 3 marks"
QString in_words(const Unsaved& unsaved);

enum class UnsavedAnswer { save, discard, cancel };
/// `before`: the action about to be done, such as "Another scan is opened."
UnsavedAnswer ask_what_becomes_of(const Unsaved& unsaved, const QString& before, QWidget* parent);

}  // namespace palpate::plugin
