#include "palpate/plugin/recording.h"

#include <fmt/format.h>
#include <hdf5.h>

#include <algorithm>
#include <memory>
#include <span>
#include <stdexcept>
#include <utility>

namespace palpate::plugin {
namespace {

/// An HDF5 identifier that closes itself.
class Handle {
 public:
  Handle(hid_t id, herr_t (*close)(hid_t), const char* what) : id_(id), close_(close) {
    if (id < 0) {
      throw std::runtime_error(fmt::format("HDF5 cannot {}", what));
    }
  }
  Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, H5I_INVALID_HID)), close_(other.close_) {}
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  Handle& operator=(Handle&&) = delete;
  ~Handle() {
    if (id_ >= 0) {
      close_(id_);
    }
  }
  operator hid_t() const { return id_; }  // NOLINT: HDF5's calls take it as it is

 private:
  hid_t id_;
  herr_t (*close_)(hid_t);
};

void check(herr_t status, const char* what) {
  if (status < 0) {
    throw std::runtime_error(fmt::format("HDF5 cannot {}", what));
  }
}

/// HDF5 prints its error stack to stderr by default; ours is in the exception.
void silence() {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);
}

struct Member {
  const char* name;
  std::size_t offset;
  hid_t type;
  hsize_t count = 1;
};

Handle make_row_type(std::size_t size, std::span<const Member> members) {
  Handle row(H5Tcreate(H5T_COMPOUND, size), H5Tclose, "make a row type");
  for (const Member& member : members) {
    if (member.count == 1) {
      check(H5Tinsert(row, member.name, member.offset, member.type), "make a row type");
    } else {
      const Handle array(H5Tarray_create2(member.type, 1, &member.count), H5Tclose, "make a row type");
      check(H5Tinsert(row, member.name, member.offset, array), "make a row type");
    }
  }
  return row;
}

Handle frame_type() {
  const hid_t f64 = H5T_NATIVE_DOUBLE;
  const hid_t u32 = H5T_NATIVE_UINT32;
  const Member members[] = {{"index", offsetof(Frame, index), H5T_NATIVE_UINT64},
                            {"time_s", offsetof(Frame, time_s), f64},
                            {"dt_s", offsetof(Frame, dt_s), f64},
                            {"probe_m", offsetof(Frame, probe_m), f64, 3},
                            {"proxy_m", offsetof(Frame, proxy_m), f64, 3},
                            {"force_n", offsetof(Frame, force_n), f64, 3},
                            {"sent_n", offsetof(Frame, sent_n), f64, 3},
                            {"value", offsetof(Frame, value), f64},
                            {"residual_n", offsetof(Frame, residual_n), f64},
                            {"error_bound_m", offsetof(Frame, error_bound_m), f64},
                            {"scene_epoch", offsetof(Frame, scene_epoch), u32},
                            {"sub_steps", offsetof(Frame, sub_steps), u32},
                            {"iterations", offsetof(Frame, iterations), u32},
                            {"solver", offsetof(Frame, solver), u32},
                            {"outcome", offsetof(Frame, outcome), u32},
                            {"safety", offsetof(Frame, safety), u32},
                            {"share_count", offsetof(Frame, share_count), u32},
                            {"buttons", offsetof(Frame, buttons), u32},
                            {"from_brick", offsetof(Frame, from_brick), u32},
                            {"stage_ns", offsetof(Frame, stage_ns), u32, stage_count}};
  return make_row_type(sizeof(Frame), members);
}

Handle share_type() {
  const Member members[] = {{"frame", offsetof(Share, frame), H5T_NATIVE_UINT64},
                            {"mode", offsetof(Share, mode), H5T_NATIVE_UINT32},
                            {"type", offsetof(Share, type), H5T_NATIVE_UINT32},
                            {"strength_n", offsetof(Share, strength_n), H5T_NATIVE_DOUBLE},
                            {"force_n", offsetof(Share, force_n), H5T_NATIVE_DOUBLE, 3}};
  return make_row_type(sizeof(Share), members);
}

template <typename Row>
void write_table(hid_t file, const char* name, const Handle& type, const std::vector<Row>& rows) {
  const hsize_t count = rows.size();
  const hsize_t unlimited = H5S_UNLIMITED;
  const hsize_t chunk = 4096;
  const Handle space(H5Screate_simple(1, &count, &unlimited), H5Sclose, "make a table");
  const Handle properties(H5Pcreate(H5P_DATASET_CREATE), H5Pclose, "make a table");
  check(H5Pset_chunk(properties, 1, &chunk), "make a table");
  check(H5Pset_shuffle(properties), "make a table");
  check(H5Pset_deflate(properties, 1), "make a table");
  const Handle table(H5Dcreate2(file, name, type, space, H5P_DEFAULT, properties, H5P_DEFAULT), H5Dclose,
                     "make a table");
  check(H5Dwrite(table, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()), "write (is the disk full?)");
}

template <typename Row>
std::vector<Row> read_table(hid_t file, const char* name, const Handle& type) {
  const Handle table(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose, "find a table");
  const Handle space(H5Dget_space(table), H5Sclose, "read a table");
  std::vector<Row> rows(static_cast<std::size_t>(std::max<hssize_t>(0, H5Sget_simple_extent_npoints(space))));
  check(H5Dread(table, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, rows.data()), "read a table");
  return rows;
}

void write_text(hid_t file, const char* name, const std::string& text) {
  const Handle type(H5Tcopy(H5T_C_S1), H5Tclose, "write an attribute");
  check(H5Tset_size(type, std::max<std::size_t>(1, text.size())), "write an attribute");
  check(H5Tset_cset(type, H5T_CSET_UTF8), "write an attribute");
  const Handle space(H5Screate(H5S_SCALAR), H5Sclose, "write an attribute");
  // A dataset, not an attribute: an attribute in the object's header may not pass 64 KiB, and a scene can.
  const Handle data(H5Dcreate2(file, name, type, space, H5P_DEFAULT, H5P_DEFAULT, H5P_DEFAULT), H5Dclose,
                    "write a text");
  check(H5Dwrite(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.c_str()), "write a text (is the disk full?)");
}

std::string read_text(hid_t file, const char* name) {
  const Handle data(H5Dopen2(file, name, H5P_DEFAULT), H5Dclose, "find a text");
  const Handle type(H5Dget_type(data), H5Tclose, "read a text");
  std::string text(H5Tget_size(type), '\0');
  check(H5Dread(data, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, text.data()), "read a text");
  text.resize(std::min(text.size(), text.find('\0')));
  return text;
}

}  // namespace

void write_recording(const Recording& recording, const std::filesystem::path& file) {
  silence();
  const std::filesystem::path partial = file.string() + ".partial";
  try {
    const Handle output(H5Fcreate(partial.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT), H5Fclose,
                        "create the file (does its folder exist, and may you write there?)");
    write_text(output, "palpate_version", recording.header.palpate_version);
    write_text(output, "scene", recording.header.scene);
    write_text(output, "device", recording.header.device);
    write_text(output, "scan_hash", recording.header.scan_hash);
    write_text(output, "seed", fmt::format("{}", recording.header.seed));
    write_table(output, "frames", frame_type(), recording.frames);
    write_table(output, "shares", share_type(), recording.shares);
    check(H5Fflush(output, H5F_SCOPE_GLOBAL), "write (is the disk full?)");
  } catch (const std::runtime_error& error) {
    std::error_code ignored;
    std::filesystem::remove(partial, ignored);
    throw std::runtime_error(fmt::format("cannot write the recording {}: {}", file.string(), error.what()));
  }
  std::filesystem::rename(partial, file);
}

Recording read_recording(const std::filesystem::path& file) {
  silence();
  try {
    const Handle input(H5Fopen(file.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT), H5Fclose,
                       "open it (is it a recording of Palpate's?)");
    Recording recording;
    recording.header.palpate_version = read_text(input, "palpate_version");
    recording.header.scene = read_text(input, "scene");
    recording.header.device = read_text(input, "device");
    recording.header.scan_hash = read_text(input, "scan_hash");
    recording.header.seed = std::stod(read_text(input, "seed"));
    recording.frames = read_table<Frame>(input, "frames", frame_type());
    recording.shares = read_table<Share>(input, "shares", share_type());
    return recording;
  } catch (const std::exception& error) {
    throw std::runtime_error(fmt::format("cannot read the recording {}: {}", file.string(), error.what()));
  }
}

}  // namespace palpate::plugin
