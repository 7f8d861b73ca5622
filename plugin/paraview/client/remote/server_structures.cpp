#include "plugin/paraview/client/remote/server_structures.h"

#include <pqServer.h>
#include <vtkNew.h>
#include <vtkPVSession.h>
#include <vtkSMSession.h>
#include <vtkSMSourceProxy.h>

#include <QTimer>

#include <exception>
#include <fstream>
#include <map>
#include <system_error>
#include <utility>

#include "plugin/messages/messages.h"
#include "plugin/paraview/client/remote/server_series.h"
#include "plugin/paraview/client/words.h"
#include "plugin/paraview/server/module/PalpateScanSlices.h"
#include "plugin/structures/structure_files.h"

namespace palpate::plugin {
namespace {

constexpr int pieces_at_a_time = 4;

}  // namespace

void ServerStructures::get(pqPipelineSource& reader, Done done) {
  cancel();
  reader_ = &reader;
  done_ = std::move(done);
  next(&ServerStructures::ask_files);
}

void ServerStructures::cancel() {
  ++run_;
  done_ = {};
  files_.clear();
  places_.clear();
  here_.clear();
  set_fetched_files({});
  folder_.reset();
  file_ = 0;
  piece_ = 0;
}

void ServerStructures::next(void (ServerStructures::*step)()) {
  constexpr int soon_ms = 20;
  QTimer::singleShot(soon_ms, this, [this, step, run = run_] {
    if (run != run_ || !reader_) return;
    if (is_free(*reader_->getServer())) {
      (this->*step)();
    } else {
      next(step);
    }
  });
}

bool ServerStructures::ask(const SlicesAsked& asked, SlicesAnswered& answered) {
  vtkNew<PalpateScanSlices> slices;
  slices->asked() = asked;
  slices->answered().error = say("does-not-answer");  // an answer takes this away
  vtkSMProxy& proxy = *reader_->getProxy();
  const unsigned run = run_;
  proxy.GetSession()->GatherInformation(vtkPVSession::DATA_SERVER_ROOT, slices, proxy.GetGlobalID());
  if (run != run_) return false;  // given up meanwhile: the server went
  answered = std::move(slices->answered());
  if (answered.error.empty()) return true;
  finish(words(say("server-cannot-give-the-structures", answered.error)));
  return false;
}

void ServerStructures::ask_files() {
  SlicesAnswered answered;
  if (!ask({.what = SlicesAsked::What::structures}, answered)) return;
  try {
    files_ = served_files_of(answered.structures);
  } catch (const std::exception& error) {
    finish(words(say("server-cannot-give-the-structures", error.what())));
    return;
  }
  if (files_.empty()) {
    finish({});
    return;
  }
  folder_ = std::make_unique<QTemporaryDir>();
  for (const std::filesystem::path& place : places_of(files_)) {
    places_.push_back(std::filesystem::path(folder_->path().toStdString()) / "structures" / place);
    std::error_code full;  // which is found when it is written
    std::filesystem::create_directories(places_.back().parent_path(), full);
  }
  next(&ServerStructures::ask_pieces);
}

void ServerStructures::ask_pieces() {
  const ServedFile file = files_[file_];
  const std::filesystem::path place = places_[file_];
  SlicesAnswered answered;
  if (!ask({.what = SlicesAsked::What::structure_pieces,
            .frame = static_cast<int>(file_),
            .first = piece_,
            .count = pieces_at_a_time},
           answered)) {
    return;
  }
  {
    std::ofstream output(place, piece_ == 0 ? std::ios::binary | std::ios::trunc : std::ios::binary | std::ios::app);
    output.write(reinterpret_cast<const char*>(answered.bytes.data()),
                 static_cast<std::streamsize>(answered.bytes.size()));
  }
  piece_ += pieces_at_a_time;
  if (static_cast<std::uint64_t>(piece_) * bytes_of_piece >= file.bytes) {
    if (hash_of_file(place) != file.hash) {
      finish(words(say("structures-did-not-arrive")));
      return;
    }
    here_.push_back(place);
    piece_ = 0;
    ++file_;
  }
  if (file_ == files_.size()) {
    finish({});
  } else {
    next(&ServerStructures::ask_pieces);
  }
}

void ServerStructures::finish(const QString& said) {
  std::map<std::filesystem::path, std::filesystem::path> here_by_name;
  for (std::size_t n = 0; n < here_.size(); ++n) here_by_name.emplace(files_[n].path, here_[n]);
  set_fetched_files(std::move(here_by_name));
  const Done done = std::exchange(done_, {});
  if (done) done(here_, said);
}

}  // namespace palpate::plugin
