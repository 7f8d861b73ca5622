#include "plugin/openigtlink/bytes.h"

namespace palpate::plugin::igtl {

void Writer::raw(ByteView bytes) {
  bytes_.insert(bytes_.end(), bytes.begin(), bytes.end());
}

}  // namespace palpate::plugin::igtl
