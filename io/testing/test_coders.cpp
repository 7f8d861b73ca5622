#include "io/testing/test_coders.h"

#include <charls/charls.h>
#include <dcmtk/dcmdata/dcpixel.h>
#include <dcmtk/dcmdata/dcpixseq.h>
#include <dcmtk/dcmdata/dcpxitem.h>
#include <dcmtk/dcmdata/dcrleerg.h>
#include <dcmtk/dcmdata/dcuid.h>
#include <dcmtk/dcmjpeg/djencode.h>
#include <openjpeg.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>

#include "io/testing/file_bytes.h"
#include "io/testing/test_image.h"

namespace palpate::io::internal {

void register_encoders() {
  static const bool once = [] {
    DJEncoderRegistration::registerCodecs();
    DcmRLEEncoderRegistration::registerCodecs();
    return true;
  }();
  static_cast<void>(once);
}

// JPEG 2000 is unknown to DCMTK, and its JPEG-LS encoder writes beyond its buffers: these two come from their own
// libraries.

namespace {

OPJ_SIZE_T append(void* bytes, OPJ_SIZE_T count, void* user) {
  auto& out = *static_cast<std::vector<Uint8>*>(user);
  out.insert(out.end(), static_cast<const Uint8*>(bytes), static_cast<const Uint8*>(bytes) + count);
  return count;
}

}  // namespace

std::vector<Uint8> jpeg2000(int columns, int rows, int bits, bool is_signed,
                            const std::function<int(int, int)>& value) {
  opj_image_cmptparm_t shape{};
  shape.dx = shape.dy = 1;
  shape.w = static_cast<OPJ_UINT32>(columns);
  shape.h = static_cast<OPJ_UINT32>(rows);
  shape.prec = static_cast<OPJ_UINT32>(bits);
  shape.sgnd = is_signed ? 1 : 0;
  const std::unique_ptr<opj_image_t, void (*)(opj_image_t*)> image(opj_image_create(1, &shape, OPJ_CLRSPC_GRAY),
                                                                   opj_image_destroy);
  image->x1 = shape.w;
  image->y1 = shape.h;
  for (int n = 0; n < columns * rows; ++n) image->comps[0].data[n] = value(n % columns, n / columns);
  opj_cparameters_t parameters;
  opj_set_default_encoder_parameters(&parameters);
  parameters.tcp_numlayers = 1;
  parameters.cp_disto_alloc = 1;
  parameters.numresolution = 3;
  const std::unique_ptr<opj_codec_t, void (*)(opj_codec_t*)> codec(opj_create_compress(OPJ_CODEC_J2K),
                                                                   opj_destroy_codec);
  const std::unique_ptr<opj_stream_t, void (*)(opj_stream_t*)> stream(opj_stream_create(1U << 20, OPJ_FALSE),
                                                                      opj_stream_destroy);
  std::vector<Uint8> bytes;
  opj_stream_set_user_data(stream.get(), &bytes, nullptr);
  opj_stream_set_write_function(stream.get(), append);
  if (!opj_setup_encoder(codec.get(), &parameters, image.get()) ||
      !opj_start_compress(codec.get(), image.get(), stream.get()) || !opj_encode(codec.get(), stream.get()) ||
      !opj_end_compress(codec.get(), stream.get())) {
    throw std::runtime_error("OpenJPEG cannot encode the test image");
  }
  return bytes;
}

void encapsulate(DcmDataset& dataset, E_TransferSyntax syntax, const std::vector<std::vector<Uint8>>& frames,
                 std::size_t longest) {
  auto sequence = std::make_unique<DcmPixelSequence>(DCM_PixelSequenceTag);
  succeed(sequence->insert(new DcmPixelItem(DCM_PixelItemTag)));
  for (std::vector<Uint8> bytes : frames) {
    if (bytes.size() % 2 != 0) bytes.push_back(0);
    for (std::size_t at = 0; at < bytes.size(); at += longest) {
      auto item = std::make_unique<DcmPixelItem>(DCM_PixelItemTag);
      succeed(item->putUint8Array(bytes.data() + at, static_cast<unsigned long>(std::min(longest, bytes.size() - at))));
      succeed(sequence->insert(item.release()));
    }
  }
  auto pixels = std::make_unique<DcmPixelData>(DCM_PixelData);
  pixels->putOriginalRepresentation(syntax, nullptr, sequence.release());
  succeed(dataset.insert(pixels.release(), OFTrue));
}

std::vector<Uint8> jpeg_ls(int columns, int rows, int bits, int near, const std::function<int(int, int)>& value) {
  std::vector<Uint16> pixels;
  pixels.reserve(static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows));
  for (int n = 0; n < columns * rows; ++n) {
    pixels.push_back(static_cast<Uint16>(value(n % columns, n / columns) & ((1 << bits) - 1)));
  }
  const std::vector<Uint8> bytes(pixels.begin(), pixels.end());
  charls::jpegls_encoder encoder;
  encoder.frame_info({static_cast<std::uint32_t>(columns), static_cast<std::uint32_t>(rows), bits, 1})
      .near_lossless(near);
  std::vector<Uint8> coded(encoder.estimated_destination_size());
  encoder.destination(coded);
  coded.resize(bits > 8 ? encoder.encode(pixels.data(), pixels.size() * 2)
                        : encoder.encode(bytes.data(), bytes.size()));
  return coded;
}

void call_deflated_frames(const std::filesystem::path& file) {
  std::string bytes = bytes_of(file);
  const std::string said = UID_JPEG2000LosslessOnlyTransferSyntax;
  bytes.replace(bytes.find(said), said.size(), std::string("1.2.840.10008.1.2.8.1\0", said.size()));
  write_bytes(file, bytes);
}

}  // namespace palpate::io::internal
