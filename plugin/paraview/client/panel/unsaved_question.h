#pragma once

/// What is not saved, in words, and the question what is to become of it.

#include <QString>
#include <QWidget>

#include "plugin/paraview/client/model/unsaved_work.h"

namespace palpate::plugin {

/// "the edited scene, the corrected outline of Liver, 3 marks"
QString in_words(const Unsaved& unsaved);

enum class UnsavedAnswer { save, discard, cancel };
/// `before`: what is about to be done, as "Another scan is opened."
UnsavedAnswer ask_what_becomes_of(const Unsaved& unsaved, const QString& before, QWidget* parent);

}  // namespace palpate::plugin
