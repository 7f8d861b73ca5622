#pragma once

/// HDF5's C interface, with identifiers that are closed automatically and errors as exceptions.

#include <hdf5.h>

#include <stdexcept>
#include <utility>

#include "plugin/messages/messages.h"

namespace palpate::plugin::hdf5 {

/// The id of the message about a failed step.
using Step = ChosenMessage<0, messages::sessions>;

class Handle {
 public:
  Handle() = default;
  Handle(hid_t id, herr_t (*close)(hid_t), Step what) : id_(id), close_(close) {
    if (id < 0) {
      throw Refusal(say("hdf5-cannot", what.filled()));
    }
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle& operator=(Handle&& other) noexcept {
    std::swap(id_, other.id_);
    std::swap(close_, other.close_);
    return *this;
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  ~Handle() {
    if (id_ >= 0) {
      close_(id_);
    }
  }
  operator hid_t() const { return id_; }  // NOLINT: HDF5's functions take the identifier itself

  /// Not closed after a failed write, because closing would write again.
  void forget() noexcept { id_ = H5I_INVALID_HID; }

 private:
  hid_t id_ = H5I_INVALID_HID;
  herr_t (*close_)(hid_t) = nullptr;
};

inline void check(herr_t status, Step what) {
  if (status < 0) {
    throw Refusal(say("hdf5-cannot", what.filled()));
  }
}

/// By default HDF5 prints its error stack to stderr, separately in each thread; here exceptions report it. And if
/// a file could not be written, HDF5 must not write to it again when the program ends.
inline void silence() {
  H5dont_atexit();
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

}  // namespace palpate::plugin::hdf5
