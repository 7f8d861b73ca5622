#pragma once

/// HID devices of the test's own in place of hidapi's, after hidapi's documentation. Where there is no FakeHidApi,
/// hidapi itself is called.

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
  FakeHid* device = nullptr;  ///< what is mounted, by the clock
};

/// What a read brings: bytes, or an error and what errno is then.
struct FakeHidInput {
  static constexpr int without_errno = -1;  ///< it stays as it was
  std::vector<std::uint8_t> bytes;
  int failed = 0;
};

/// One at a time.
class FakeHidApi {
 public:
  FakeHidApi();
  FakeHidApi(const FakeHidApi&) = delete;
  FakeHidApi& operator=(const FakeHidApi&) = delete;
  ~FakeHidApi();

  std::vector<FakeHidNode> nodes;
  bool starts = true;
  std::deque<FakeHidInput> input;  ///< read next; empty: nothing comes
  bool takes = true;               ///< reports are written
  std::function<void()> on_write;  ///< after a report was written, in the thread that wrote it

  // What was asked.
  std::string opened;  ///< the last path
  std::vector<int> waits_ms;
  std::vector<std::vector<std::uint8_t>> written;  ///< with the report's number

  // What is held.
  int lists = 0, handles = 0;
};

}  // namespace palpate::device
