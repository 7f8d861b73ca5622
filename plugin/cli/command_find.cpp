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
  fmt::print("{}\n", json.dump(1, ' ', false, nlohmann::ordered_json::error_handler_t::replace));
}

void print_found(const io::Found& found) {
  for (const io::ArchivedStudy& study : found.studies) {
    fmt::print("{}  {}  {}  \"{}\"\n   study {}\n", for_terminal(study.patient), for_terminal(study.patient_id),
               for_terminal(study.date), for_terminal(study.description), for_terminal(study.uid));
    for (const io::ArchivedSeries& series : study.series) {
      fmt::print("   {:>4}  {}  {} images  \"{}\"\n         series {}\n", series.number, for_terminal(series.modality),
                 series.images, for_terminal(series.description), for_terminal(series.uid));
    }
  }
  if (found.studies.empty()) fmt::print("nothing found\n");
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
  CLI::App* command = program.add_subcommand("find", "Studies and series that an archive holds (C-FIND)");
  const auto options = std::make_shared<FindOptions>();
  add_archive_option(*command, options->archive);
  io::ArchiveQuery& query = options->query;
  command->add_option("--patient", query.patient, "part of the patient's name, family name first");
  command->add_option("--id", query.patient_id, "the patient's id");
  command->add_option("--date", query.date,
                      "the study's: YYYYMMDD, or a span YYYYMMDD-YYYYMMDD with either end left out");
  command->add_option("--modality", query.modality, "CT, MR, ...");
  command->add_option("--description", query.description, "part of the study's description");
  command->add_option("--most", query.most_studies, "how many studies to list")->capture_default_str();
  command->add_flag("--json", options->json, "for machines");
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin
