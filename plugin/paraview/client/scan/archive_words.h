#pragma once

/// Adapts messages about archives to the panel: they name command-line options, while the panel has fields.

#include <QString>

namespace palpate::plugin {

/// The label of the field for an option of `palpate archive add`, such as "--host"; empty: there is no such field.
QString label_of(const QString& option);

/// The text with field labels in place of options.
QString in_fields(const QString& said);

}  // namespace palpate::plugin
