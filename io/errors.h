#pragma once

#include <stdexcept>

#include "solver/text/message.h"

namespace palpate::io {

/// A file, folder or series that cannot be read. The message names it and says what to do.
class DicomError : public Refusal {
 public:
  using Refusal::Refusal;
};

/// The progress callback stopped the work. No incomplete result is left.
class Cancelled : public std::runtime_error {
 public:
  Cancelled() : std::runtime_error("cancelled") {}
};

}  // namespace palpate::io
