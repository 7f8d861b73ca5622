#include <openjpeg.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <memory>

#include "io/dicom/decode.h"
#include "io/errors.h"
#include "io/messages.h"

namespace palpate::io::internal {
namespace {

struct Source {
  std::span<const std::byte> bytes;
  std::size_t at = 0;
};

OPJ_SIZE_T read(void* buffer, OPJ_SIZE_T wanted, void* user) {
  auto& source = *static_cast<Source*>(user);
  const std::size_t left = source.bytes.size() - source.at;
  if (left == 0) return static_cast<OPJ_SIZE_T>(-1);
  const std::size_t count = std::min<std::size_t>(wanted, left);
  std::memcpy(buffer, source.bytes.data() + source.at, count);
  source.at += count;
  return count;
}

OPJ_OFF_T skip(OPJ_OFF_T count, void* user) {
  auto& source = *static_cast<Source*>(user);
  if (count < 0) return -1;
  const std::size_t moved = std::min<std::size_t>(static_cast<std::size_t>(count), source.bytes.size() - source.at);
  source.at += moved;
  return static_cast<OPJ_OFF_T>(moved);
}

OPJ_BOOL seek(OPJ_OFF_T to, void* user) {
  auto& source = *static_cast<Source*>(user);
  if (to < 0 || static_cast<std::size_t>(to) > source.bytes.size()) return OPJ_FALSE;
  source.at = static_cast<std::size_t>(to);
  return OPJ_TRUE;
}

using Stream = std::unique_ptr<opj_stream_t, void (*)(opj_stream_t*)>;
using Codec = std::unique_ptr<opj_codec_t, void (*)(opj_codec_t*)>;

Stream stream_of(Source& source) {
  Stream stream(opj_stream_create(1U << 16, OPJ_TRUE), opj_stream_destroy);
  opj_stream_set_user_data(stream.get(), &source, nullptr);
  opj_stream_set_user_data_length(stream.get(), source.bytes.size());
  opj_stream_set_read_function(stream.get(), read);
  opj_stream_set_skip_function(stream.get(), skip);
  opj_stream_set_seek_function(stream.get(), seek);
  return stream;
}

// OpenJPEG carries on over damaged packets and only warns. Warnings while it reads the header are matters of style.
void note_damage(const char* /*message*/, void* damaged) {
  *static_cast<bool*>(damaged) = true;
}

[[noreturn]] void refuse(const Text& why) {
  throw DicomError(say("jpeg-2000", why));
}

}  // namespace

Text decode_jpeg2000(const PixelFormat& format, std::span<const std::byte> bytes, std::span<std::uint16_t> values) {
  Source source{bytes};
  const bool bare = bytes.size() > 2 && bytes[0] == std::byte{0xFF} && bytes[1] == std::byte{0x4F};
  const Stream stream = stream_of(source);
  const Codec codec(opj_create_decompress(bare ? OPJ_CODEC_J2K : OPJ_CODEC_JP2), opj_destroy_codec);
  opj_dparameters_t parameters;
  opj_set_default_decoder_parameters(&parameters);
  // A truncated image is refused, not completed with gray.
  const bool is_ready =
      opj_setup_decoder(codec.get(), &parameters) && opj_decoder_set_strict_mode(codec.get(), OPJ_TRUE);

  opj_image_t* read_image = nullptr;
  const bool has_header = is_ready && opj_read_header(stream.get(), codec.get(), &read_image) == OPJ_TRUE;
  const std::unique_ptr<opj_image_t, void (*)(opj_image_t*)> image(read_image, opj_image_destroy);
  if (!has_header || !image) refuse(say("jpeg-2000-no-header"));
  // Before anything is decoded: its own header decides how much memory that takes.
  const auto columns = static_cast<OPJ_UINT32>(format.columns);
  const auto rows = static_cast<OPJ_UINT32>(format.rows);
  if (image->numcomps != 1 || image->x1 - image->x0 != columns || image->y1 - image->y0 != rows) {
    refuse(say("jpeg-2000-size"));
  }
  if (image->comps[0].prec > 16 || image->comps[0].dx != 1 || image->comps[0].dy != 1) refuse(say("jpeg-2000-kind"));
  bool damaged = false;
  opj_set_warning_handler(codec.get(), note_damage, &damaged);
  const bool is_decoded = opj_decode(codec.get(), stream.get(), image.get()) == OPJ_TRUE;
  const opj_image_comp_t& component = image->comps[0];
  if (!is_decoded || component.data == nullptr || component.w != columns || component.h != rows) {
    refuse(say("jpeg-2000-ends-early"));
  }
  if (damaged) refuse(say("jpeg-2000-holds-errors"));
  // Sign and unused bits are handled as for every other coder, by the file's header.
  std::transform(component.data, component.data + values.size(), values.begin(),
                 [](OPJ_INT32 v) { return static_cast<std::uint16_t>(v); });
  return {};
}

}  // namespace palpate::io::internal
