#include "plugin/paraview/client/jobs/scan_loader.h"

#include <QMetaObject>

#include <exception>
#include <filesystem>
#include <utility>

#include "io/errors.h"
#include "io/fields/filtered.h"
#include "plugin/app/scan_choice.h"
#include "plugin/paraview/client/jobs/thumbnail.h"
#include "plugin/paraview/common/scan_store.h"
#include "plugin/session/scan_hash.h"

namespace palpate::plugin {

ScanLoader::~ScanLoader() {
  cancel();
}

void ScanLoader::cancel() {
  *cancelled_ = true;
  if (thread_.joinable()) thread_.join();
  busy_ = false;
}

template <typename Result, typename Work, typename Done>
void ScanLoader::start(Work work, Progress progress, Done done) {
  cancel();
  cancelled_ = std::make_shared<std::atomic<bool>>(false);
  busy_ = true;
  thread_ = std::thread(
      [this, cancelled = cancelled_, work = std::move(work), progress = std::move(progress), done = std::move(done)] {
        const auto on_ui = [this, cancelled](auto call) {
          QMetaObject::invokeMethod(
              &receiver_,
              [cancelled, call] {
                if (!*cancelled) call();
              },
              Qt::QueuedConnection);
        };
        int told = -1;
        const io::Progress tell = [&](double part) {
          if (const int percent = static_cast<int>(100 * part); percent != std::exchange(told, percent)) {
            on_ui([progress, part] { progress(part); });
          }
          return !*cancelled;
        };
        Result result;
        std::string error;
        try {
          result = work(tell);
        } catch (const io::Cancelled&) {
        } catch (const std::exception& failure) {
          error = failure.what();
        }
        on_ui([this, done, result, error] {
          busy_ = false;
          done(result, error);
        });
      });
}

void ScanLoader::find(const std::string& path, Progress progress, Found found) {
  start<std::shared_ptr<const io::Catalogue>>([path](const io::Progress& tell) { return find_scans(path, tell); },
                                              std::move(progress), std::move(found));
}

void ScanLoader::load(const io::Series& series, int frame, const io::Filter& filter, Progress progress, Loaded loaded) {
  start<std::shared_ptr<const io::Volume>>(
      [series, frame, filter](const io::Progress& tell) { return load_scan(series, frame, filter, tell); },
      std::move(progress), std::move(loaded));
}

void ScanLoader::filter(std::shared_ptr<const io::Volume> volume, const io::Filter& filter, Progress progress,
                        Loaded loaded) {
  start<std::shared_ptr<const io::Volume>>(
      [volume = std::move(volume), filter](const io::Progress& tell) { return io::filtered(volume, filter, tell); },
      std::move(progress), std::move(loaded));
}

void ScanLoader::find_copies(std::vector<std::string> places, const std::string& name, const glm::ivec3& size,
                             Progress progress,
                             std::function<void(const std::vector<ScanCopy>&, const std::string& error)> found) {
  start<std::vector<ScanCopy>>(
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
  start<std::shared_ptr<const io::Volume>>(
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
  start<std::shared_ptr<const ScanStudy>>(
      [volume = std::move(volume)](const io::Progress& tell) {
        return std::make_shared<const ScanStudy>(study_scan(volume, tell));
      },
      std::move(progress), std::move(studied));
}

void ScanLoader::draw_thumbnails(std::shared_ptr<const io::Catalogue> catalogue,
                                 std::function<void(std::size_t, const QImage&)> drawn) {
  start<bool>(
      [this, catalogue = std::move(catalogue), drawn = std::move(drawn)](const io::Progress& tell) {
        for (std::size_t n = 0; n < catalogue->series.size(); ++n) {
          if (!tell(0)) throw io::Cancelled();
          const QImage image = thumbnail_of(catalogue->series[n]);
          QMetaObject::invokeMethod(
              &receiver_, [drawn, n, image] { drawn(n, image); }, Qt::QueuedConnection);
        }
        return true;
      },
      [](double) {}, [](bool, const std::string&) {});
}

}  // namespace palpate::plugin
