#include "plugin/paraview/client/jobs/scan_loader.h"

#include <filesystem>
#include <type_traits>
#include <utility>

#include "io/errors.h"
#include "io/fields/filtered.h"
#include "plugin/app/scan_choice.h"
#include "plugin/paraview/client/jobs/thumbnail.h"
#include "plugin/paraview/common/scan_store.h"
#include "plugin/session/scan_hash.h"

namespace palpate::plugin {

template <typename Work, typename Done>
void ScanLoader::start(Work work, Progress progress, Done done) {
  job_.ask([work = std::move(work),
            progress = std::move(progress)](const Job::Control& control) { return work(control.progress(progress)); },
           [done = std::move(done)](const auto& result, const QString& error) {
             using Result = std::decay_t<decltype(*result)>;
             done(result ? *result : Result(), error.toStdString());
           });
}

void ScanLoader::find(const std::string& path, Progress progress, Found found) {
  start([path](const io::Progress& tell) { return find_scans(path, tell); }, std::move(progress), std::move(found));
}

void ScanLoader::load(const io::Series& series, int frame, const io::Filter& filter, Progress progress, Loaded loaded) {
  start([series, frame, filter](const io::Progress& tell) { return load_scan(series, frame, filter, tell); },
        std::move(progress), std::move(loaded));
}

void ScanLoader::filter(std::shared_ptr<const io::Volume> volume, const io::Filter& filter, Progress progress,
                        Loaded loaded) {
  start([volume = std::move(volume), filter](const io::Progress& tell) { return io::filtered(volume, filter, tell); },
        std::move(progress), std::move(loaded));
}

void ScanLoader::find_copies(std::vector<std::string> places, const std::string& name, const glm::ivec3& size,
                             Progress progress,
                             std::function<void(const std::vector<ScanCopy>&, const std::string& error)> found) {
  start(
      [places = std::move(places), name, size](const io::Progress& tell) {
        std::vector<ScanCopy> copies;
        for (const std::string& place : places) {
          std::error_code ignored;
          if (!std::filesystem::exists(place, ignored)) continue;
          try {
            const auto catalogue = find_scans(place, tell);
            for (std::size_t n = 0; n < scan_count(*catalogue); ++n) {
              const bool same_size = scan_at(*catalogue, n).geometry.dimensions == size;
              if (same_size && scan_name(*catalogue, n) == name) copies.push_back({catalogue, n});
            }
          } catch (const io::DicomError&) {  // not readable: no copy
          }
        }
        return copies;
      },
      std::move(progress), std::move(found));
}

void ScanLoader::load_copy(std::vector<ScanCopy> copies, int frame, const std::string& hash, Progress progress,
                           Loaded loaded) {
  start(
      [copies = std::move(copies), frame, hash](const io::Progress& tell) -> std::shared_ptr<const io::Volume> {
        for (const ScanCopy& copy : copies) {
          const io::Series& series = scan_at(*copy.catalogue, copy.series);
          if (frame >= series.frames_per_position) continue;
          try {
            auto volume = load_scan(series, frame, tell);
            if (hash_of(*volume) == hash) return volume;
          } catch (const io::DicomError&) {  // the next may be whole
          }
        }
        return nullptr;
      },
      std::move(progress), std::move(loaded));
}

void ScanLoader::study(std::shared_ptr<const io::Volume> volume, Progress progress, Studied studied) {
  start([volume = std::move(volume)](
            const io::Progress& tell) { return std::make_shared<const ScanStudy>(study_scan(volume, tell)); },
        std::move(progress), std::move(studied));
}

void ScanLoader::draw_thumbnails(std::shared_ptr<const io::Catalogue> catalogue,
                                 std::function<void(std::size_t, const QImage&)> drawn) {
  job_.ask(
      [catalogue = std::move(catalogue), drawn = std::move(drawn)](const Job::Control& control) {
        for (std::size_t n = 0; n < catalogue->series.size() && control.keep_going(); ++n) {
          control.tell([drawn, n, image = thumbnail_of(catalogue->series[n])] { drawn(n, image); });
        }
        return true;
      },
      [](const auto& /*all*/, const QString& /*error*/) {});
}

}  // namespace palpate::plugin
