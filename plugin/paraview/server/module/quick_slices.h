#pragma once

namespace palpate::plugin {

/// ParaView's representation of an image as a slice copies a sagittal one value by value, twice, and each copy goes
/// through its whole machinery: more than all else that it does for a picture. From the first call on those that are
/// made, whatever image they show, take the slice at once, and once. Not where a server draws or sends them.
void quicken_slices();

}  // namespace palpate::plugin
