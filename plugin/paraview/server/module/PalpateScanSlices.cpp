#include "plugin/paraview/server/module/PalpateScanSlices.h"
#include "plugin/messages/messages.h"

#include <vtkClientServerStream.h>
#include <vtkMultiProcessStream.h>
#include <vtkObjectFactory.h>

#include <cstdint>
#include <exception>
#include <string>
#include <type_traits>
#include <variant>
#include <vector>

#include "plugin/paraview/server/module/PalpateDicomReader.h"
#include "plugin/paraview/wire/slices_message.h"
#include "plugin/paraview/wire/structure_files_message.h"

using namespace palpate::plugin;

namespace {

template <typename T>
void put(vtkClientServerStream& stream, const std::vector<T>& values) {
  const auto* const bytes = reinterpret_cast<const unsigned char*>(values.data());
  stream << vtkClientServerStream::InsertArray(bytes, static_cast<int>(values.size() * sizeof(T)));
}

template <typename T>
std::vector<T> get(const vtkClientServerStream& stream, int argument) {
  vtkTypeUInt32 bytes = 0;
  stream.GetArgumentLength(0, argument, &bytes);
  std::vector<T> values(bytes / sizeof(T));
  if (bytes > 0) stream.GetArgument(0, argument, reinterpret_cast<unsigned char*>(values.data()), bytes);
  return values;
}

}  // namespace

vtkStandardNewMacro(PalpateScanSlices);

PalpateScanSlices::PalpateScanSlices()
    : asked_(std::make_unique<SlicesAsked>()), answered_(std::make_unique<SlicesAnswered>()) {
  SetRootOnly(1);
}

PalpateScanSlices::~PalpateScanSlices() = default;

void PalpateScanSlices::PrintSelf(ostream& os, vtkIndent indent) {
  Superclass::PrintSelf(os, indent);
  os << indent << "Slices: " << asked_->count << " from " << asked_->first << "\n";
}

void PalpateScanSlices::CopyFromObject(vtkObject* object) {
  auto* const reader = PalpateDicomReader::SafeDownCast(object);
  const palpate::io::Series* const series = reader ? reader->FoundSeries() : nullptr;
  *answered_ = {};
  if (series && asked_->what >= SlicesAsked::What::structures) {
    try {
      if (asked_->what == SlicesAsked::What::structures) {
        answered_->structures = text_of(find_served_files(reader->GetFileName()));
      } else {
        answered_->bytes = read_served_file(reader->GetFileName(), asked_->frame, asked_->first, asked_->count);
      }
    } catch (const std::exception& error) {
      answered_->error = error.what();
    }
  } else if (series) {
    *answered_ = answer(*series, *asked_);
  } else {
    answered_->error = palpate::plugin::say("server-has-not-opened-the-scan");
  }
}

void PalpateScanSlices::CopyParametersToStream(vtkMultiProcessStream& stream) {
  stream << static_cast<int>(asked_->what) << asked_->frame << asked_->first << asked_->count;
}

void PalpateScanSlices::CopyParametersFromStream(vtkMultiProcessStream& stream) {
  int what = 0;
  stream >> what >> asked_->frame >> asked_->first >> asked_->count;
  asked_->what = static_cast<SlicesAsked::What>(what);
}

void PalpateScanSlices::CopyToStream(vtkClientServerStream* stream) {
  stream->Reset();
  *stream << vtkClientServerStream::Reply << answered_->error.c_str() << answered_->head.c_str();
  put(*stream, answered_->hashes);
  *stream << static_cast<int>(answered_->voxels.index());
  std::visit([&](const auto& voxels) { put(*stream, voxels); }, answered_->voxels);
  *stream << answered_->structures.c_str();
  put(*stream, answered_->bytes);
  *stream << vtkClientServerStream::End;
}

void PalpateScanSlices::CopyFromStream(const vtkClientServerStream* stream) {
  *answered_ = {};
  int type = 0;
  if (!stream->GetArgument(0, 0, &answered_->error) || !stream->GetArgument(0, 1, &answered_->head) ||
      !stream->GetArgument(0, 3, &type) || !stream->GetArgument(0, 5, &answered_->structures)) {
    answered_->error = palpate::plugin::say("server-answers-in-another-version-way");
    return;
  }
  answered_->hashes = get<std::uint64_t>(*stream, 2);
  const auto voxels = [&](auto kind) { answered_->voxels = get<decltype(kind)>(*stream, 4); };
  if (type == 0) voxels(std::int16_t{});
  if (type == 1) voxels(std::uint16_t{});
  if (type == 2) voxels(float{});
  answered_->bytes = get<unsigned char>(*stream, 6);
}
