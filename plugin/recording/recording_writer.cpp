#include "plugin/recording/recording_writer.h"

#include <fmt/format.h>

#include <algorithm>
#include <limits>
#include <utility>
#include <vector>

#include "plugin/messages/messages.h"
#include "plugin/recording/recording_rows.h"

namespace palpate::plugin {

using hdf5::Handle;

/// A table that grows. It has linkage because RecordingWriter::File, which has members of it, has.
struct GrowingTable {
  Handle type;
  Handle data;
  hsize_t rows = 0;
};

namespace {

using hdf5::check;

constexpr hsize_t rows_of_chunk = 1024;  // 270 KB of ticks: within HDF5's cache of a chunk, a second of a session

/// A text as a dataset, not an attribute: an attribute in the object's header may not pass 64 KiB.
void write_text(hid_t file, const char* name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "make-a-table");
  check(H5Tset_size(type, std::max<std::size_t>(1, text.size())), "make-a-table");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "make-a-table");
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "make-a-table");
  const Handle data(H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose,
                    "make-a-table");
  check(H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()), "write-is-the-disk-full");
}

GrowingTable make_table(hid_t file, const char* name, Handle type, hsize_t chunk) {
  const hsize_t none = 0;
  const hsize_t unlimited = H5S_UNLIMITED;
  const Handle space(H5Screate_simple(1, &none, &unlimited), H5Sclose, "make-a-table");
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "make-a-table");
  check(H5Pset_chunk(properties, 1, &chunk), "make-a-table");
  check(H5Pset_shuffle(properties), "make-a-table");
  check(H5Pset_deflate(properties, 1), "make-a-table");
  Handle data(H5Dcreate2(file, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose, "make-a-table");
  return {std::move(type), std::move(data)};
}

void append_rows(GrowingTable& table, const void* rows, std::size_t count) {
  if (count == 0) {
    return;
  }
  const hsize_t added = count;
  const hsize_t size = table.rows + added;
  check(H5Dset_extent(table.data, &size), "write-is-the-disk-full");
  const Handle all(H5Dget_space(table.data), H5Sclose, "write-it");
  check(H5Sselect_hyperslab(all, H5S_SELECT_SET, &table.rows, nullptr, &added, nullptr), "write-it");
  const Handle memory(H5Screate_simple(1, &added, nullptr), H5Sclose, "write-it");
  check(H5Dwrite(table.data, table.type, memory, all, H5P_DEFAULT, rows), "write-is-the-disk-full");
  table.rows = size;
}

Handle create(const std::filesystem::path& file) {
  const Handle access(H5Pcreate(H5P_FILE_ACCESS), H5Pclose, "create-the-file");
  check(H5Pset_libver_bounds(access, H5F_LIBVER_V110, H5F_LIBVER_V110), "create-the-file");
  return {H5Fcreate(file.c_str(), H5F_ACC_EXCL, H5P_DEFAULT, access), H5Fclose, "create-it-there"};
}

/// A free name beside the leftovers of crashed sessions.
std::filesystem::path free_partial(const std::filesystem::path& file) {
  std::filesystem::path partial = file.string() + ".partial";
  for (int n = 2; std::filesystem::exists(partial); ++n) partial = fmt::format("{}.{}.partial", file.string(), n);
  return partial;
}

}  // namespace

struct RecordingWriter::File {
  File(const std::filesystem::path& path, const RecordingHeader& header) : file(create(path)) {
    write_text(file, "palpate_version", header.palpate_version);
    write_text(file, "device", header.device);
    write_text(file, "scan_hash", header.scan_hash);
    write_text(file, "seed", fmt::format("{}", header.seed));
    write_text(file, "rate_hz", fmt::format("{}", header.rate_hz));
    ticks = make_table(file, "frames", tick_row_type(), rows_of_chunk);
    shares = make_table(file, "shares", share_row_type(), 4 * rows_of_chunk);
    known_to = make_table(file, "known_to_mm", known_to_row_type(), rows_of_chunk);
    Handle byte(H5Tcopy(H5T_NATIVE_UINT8), H5Tclose, "make-a-table");
    events = make_table(file, "events", std::move(byte), 16 * rows_of_chunk);
    check(H5Fstart_swmr_write(file), "let-the-file-be-read-while");
  }
  void forget() noexcept {
    for (GrowingTable* table : {&ticks, &shares, &known_to, &events}) {
      table->data.forget();
    }
    file.forget();
  }

  Handle file;
  GrowingTable ticks, shares, known_to, events;
};

namespace {

/// Runs a step of the writing; its failure names the file.
template <typename Step>
void naming(const std::filesystem::path& file, Step&& step) {
  hdf5::silence();
  try {
    step();
  } catch (const std::exception& error) {
    throw Refusal(say("cannot-write-the-recording", file.string(), error.what()));
  }
}

}  // namespace

RecordingWriter::RecordingWriter(std::filesystem::path file, const RecordingHeader& header)
    : file_(std::move(file)), partial_(free_partial(file_)) {
  naming(file_, [&] { open_ = std::make_unique<File>(partial_, header); });
}

RecordingWriter::~RecordingWriter() {
  if (open_) open_->forget();
}

void RecordingWriter::append(std::span<const TickRecord> ticks, std::span<const PrimitiveRecord> shares,
                             std::span<const double> known_to_mm) {
  naming(file_, [&] {
    std::vector<double> known(known_to_mm.begin(), known_to_mm.end());
    known.resize(ticks.size(), std::numeric_limits<double>::quiet_NaN());
    // In this order: a tick in the file has its shares there.
    append_rows(open_->shares, shares.data(), shares.size());
    append_rows(open_->known_to, known.data(), known.size());
    append_rows(open_->ticks, ticks.data(), ticks.size());
  });
}

void RecordingWriter::append(const SceneRecord& scene) {
  const std::string line = to_line(scene);
  naming(file_, [&] { append_rows(open_->events, line.data(), line.size()); });
}

void RecordingWriter::append(const StylusRecord& stylus) {
  const std::string line = to_line(stylus);
  naming(file_, [&] { append_rows(open_->events, line.data(), line.size()); });
}

void RecordingWriter::append(const Gap& gap) {
  const std::string line = to_line(gap);
  naming(file_, [&] { append_rows(open_->events, line.data(), line.size()); });
}

void RecordingWriter::flush() {
  naming(file_, [&] {
    for (const GrowingTable* table : {&open_->events, &open_->shares, &open_->known_to, &open_->ticks}) {
      check(H5Dflush(table->data), "write-is-the-disk-full");
    }
  });
}

void RecordingWriter::finish() {
  flush();
  naming(file_, [&] {
    open_.reset();
    H5garbage_collect();
    std::filesystem::rename(partial_, file_);
  });
}

}  // namespace palpate::plugin
