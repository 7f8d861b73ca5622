#pragma once

#include <stdexcept>

#include "solver/text/message.h"

namespace palpate::io {

/// A file, folder or series that cannot be read. The message names it and says what to do.
class DicomError : public Refusal {
 public:
  using Refusal::Refusal;
};

/// Work that its progress callback stopped. No incomplete result is left.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace palpate::io
