#pragma once

/// Replaces hidapi by fake HID devices that follow hidapi's documentation. While no FakeHidApi exists, hidapi itself is
/// called.

#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include "device/testing/fake_hid.h"

namespace palpate::device {

struct FakeHidNode {
  std::uint16_t vendor, product, page, usage;
  std::string path;
  std::wstring name;
  bool opens = true;
  FakeHid* device = nullptr;  ///< the mounted device, by the clock
};

/// The result of a read: bytes, or an error with its errno.
struct FakeHidInput {
  static constexpr int without_errno = -1;  ///< errno is unchanged
  std::vector<std::uint8_t> bytes;
  int failed = 0;
};

/// Only one may exist at a time.
class FakeHidApi {
 public:
  FakeHidApi();
  FakeHidApi(const FakeHidApi&) = delete;
  FakeHidApi& operator=(const FakeHidApi&) = delete;
  ~FakeHidApi();

  std::vector<FakeHidNode> nodes;
  bool starts = true;
  std::deque<FakeHidInput> input;  ///< results of the next reads; empty: no data
  bool takes = true;               ///< whether reports can be written
  std::function<void()> on_write;  ///< called after a report was written, in the writing thread

  // The calls so far.
  std::string opened;  ///< the latest path
  std::vector<int> waits_ms;
  std::vector<std::vector<std::uint8_t>> written;  ///< with their numbers

  // Open resources.
  int lists = 0, handles = 0;
};

}  // namespace palpate::device
