#pragma once

/// What archives say, for the panel: their messages name the options of the command line, the panel has fields.

#include <QString>

namespace palpate::plugin {

/// The label of the field for an option of `palpate archive add`, as "--host"; empty: the panel has none.
QString label_of(const QString& option);

/// The same text with the panel's fields in place of options.
QString in_fields(const QString& said);

}  // namespace palpate::plugin
