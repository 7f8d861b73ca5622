#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "io/archive/find.h"
#include "plugin/app/archive_settings.h"
#include "plugin/app/interruptible.h"
#include "plugin/cli/archive_option.h"
#include "plugin/cli/commands.h"
#include "plugin/messages/messages.h"
#include "plugin/messages/tell.h"
#include "plugin/options/put.h"

namespace palpate::plugin {
namespace {

struct FindOptions {
  std::string archive;
  io::ArchiveQuery query;
  bool json = false;
};

void print_found_json(const io::Found& found) {
  nlohmann::ordered_json studies = nlohmann::ordered_json::array();
  for (const io::ArchivedStudy& study : found.studies) {
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const io::ArchivedSeries& series : study.series) {
      all.push_back({{"series_uid", series.uid},
                     {"modality", series.modality},
                     {"number", series.number},
                     {"description", series.description},
                     {"images", series.images}});
    }
    studies.push_back({{"study_uid", study.uid},
                       {"date", study.date},
                       {"description", study.description},
                       {"patient", study.patient},
                       {"patient_id", study.patient_id},
                       {"series", all}});
  }
  const nlohmann::ordered_json json{{"studies", studies}, {"more", found.more}};
  put_json(json, 1);
}

void print_found(const io::Found& found) {
  for (const io::ArchivedStudy& study : found.studies) {
    put("{}  {}  {}  \"{}\"\n   study {}\n", study.patient, study.patient_id, study.date, study.description, study.uid);
    for (const io::ArchivedSeries& series : study.series) {
      put("   {:>4}  {}  {} images  \"{}\"\n         series {}\n", series.number, series.modality, series.images,
          series.description, series.uid);
    }
  }
  if (found.studies.empty()) put("nothing found\n");
}

void run(const FindOptions& options) {
  const Interruptible interruptible;
  const io::Found found =
      io::find(archive_named(options.archive), options.query, [] { return !Interruptible::interrupted(); });
  options.json ? print_found_json(found) : print_found(found);
  if (found.more) {
    tell(say("more-studies-than-these", found.studies.size()));
  }
}

}  // namespace

void add_find(CLI::App& program) {
  CLI::App* command = program.add_subcommand("find", "Lists studies and series of an archive (C-FIND)");
  const auto options = std::make_shared<FindOptions>();
  add_archive_option(*command, options->archive);
  io::ArchiveQuery& query = options->query;
  command->add_option("--patient", query.patient, "part of the patient's name, family name first");
  command->add_option("--id", query.patient_id, "the patient's id");
  command->add_option("--date", query.date,
                      "the study's date: YYYYMMDD, or a span YYYYMMDD-YYYYMMDD; either end may be left out");
  command->add_option("--modality", query.modality, "CT, MR, ...");
  command->add_option("--description", query.description, "part of the study's description");
  command->add_option("--most", query.most_studies, "how many studies to list")->capture_default_str();
  command->add_flag("--json", options->json, "print JSON");
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin
