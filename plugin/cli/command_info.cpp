#include <fmt/format.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <glm/vec3.hpp>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "io/choose_first.h"
#include "io/errors.h"
#include "io/load.h"
#include "io/series.h"
#include "plugin/app/errors.h"
#include "plugin/app/open_scan.h"
#include "plugin/app/scan_choice.h"
#include "plugin/cli/commands.h"
#include "plugin/messages/messages.h"
#include "plugin/options/put.h"
#include "plugin/options/series_option.h"
#include "plugin/report/slice_picture.h"

namespace palpate::plugin {
namespace {

using Json = nlohmann::ordered_json;

struct InfoOptions {
  std::vector<std::string> paths;
  bool json = false;
  bool patient = false;
  bool all = false;
};

/// A series as its header and its voxels show it.
struct Examined {
  io::Series series;
  io::Statistics values;  // of all frames, without padding; count 0 if nothing could be read
  io::Statistics with_padding;
  bool is_first_choice = false;
  std::string name;  // for --series
};

Examined examine(io::Series series, std::string name) {
  Examined result{std::move(series), {}, {}, false, std::move(name)};
  int readable = 0;
  io::Series& s = result.series;
  for (int frame = 0; frame < s.frames_per_position; ++frame) {
    try {
      io::LoadOptions how;
      how.frame = frame;
      how.progress = terminal_progress("reading slices");
      const io::Volume volume = io::load(s, how);
      result.values = io::merge(result.values, io::statistics_without_padding(volume));
      result.with_padding = io::merge(result.with_padding, io::statistics(volume));
      ++readable;
      s.warnings.insert(s.warnings.end(), volume.warnings.begin(), volume.warnings.end());
      if (frame == 0) s.geometry = volume.geometry;  // without the slices that turned out to be unreadable
    } catch (const io::DicomError& error) {
      // Also for a series that is not a volume: the user asks why it shows nothing.
      s.warnings.push_back(error.text());
    }
  }
  s.usable = s.usable && readable > 0;
  return result;
}

Json json_of(const glm::dvec3& v) {
  return Json::array({v.x, v.y, v.z});
}

Json json_of(const Examined& examined) {
  const io::Series& s = examined.series;
  const io::Geometry& g = s.geometry;
  const bool placed = g.dimensions.x > 0;
  const bool has_values = examined.values.count > 0;
  Json json;
  json["uid"] = s.uid;
  json["study_uid"] = s.study_uid;
  json["part"] = s.part;
  json["number"] = s.details.number ? Json(*s.details.number) : Json();
  json["date"] = s.details.date;
  json["time"] = s.details.time;
  json["body_part"] = s.details.body_part;
  json["kernel"] = s.details.kernel;
  json["sequence"] = s.details.sequence;
  json["contrast"] = s.details.contrast;
  json["orientation"] = s.details.orientation;
  json["letters"] =
      placed ? Json::array({orientation_letters(g.direction_i), orientation_letters(g.direction_j)}) : Json();
  json["thickness_mm"] = s.details.thickness_mm > 0 ? Json(s.details.thickness_mm) : Json();
  json["first_choice"] = examined.is_first_choice;
  json["modality"] = s.modality;
  json["description"] = s.description;
  json["files"] = s.files.size();
  json["dimensions"] = {g.dimensions.x, g.dimensions.y, g.dimensions.z};
  json["frames_per_position"] = s.frames_per_position;
  json["frames"] = Json::array();
  for (std::size_t f = 0; f < s.frame_names.size(); ++f) {
    json["frames"].push_back({{"index", f}, {"label", s.frame_names[f]}});
  }
  json["spacing_mm"] = placed ? Json::array({g.spacing_i, g.spacing_j, g.slice_spacing()}) : Json();
  json["origin_mm"] = g.slice_positions.empty() ? Json() : json_of(g.slice_positions.front());
  json["direction_i"] = placed ? json_of(g.direction_i) : Json();
  json["direction_j"] = placed ? json_of(g.direction_j) : Json();
  json["step_mm"] = placed ? json_of(g.step) : Json();
  json["uniform"] = g.uniform;
  json["transfer_syntaxes"] = s.transfer_syntaxes;
  json["unit"] = s.unit;
  json["window"] = s.window ? Json{{"center", s.window->level}, {"width", s.window->width}} : Json();
  json["minimum"] = has_values ? Json(examined.values.minimum) : Json();
  json["maximum"] = has_values ? Json(examined.values.maximum) : Json();
  json["mean"] = has_values ? Json(examined.values.mean) : Json();
  const bool has_any = examined.with_padding.count > 0;  // also where all is padding
  json["minimum_with_padding"] = has_any ? Json(examined.with_padding.minimum) : Json();
  json["maximum_with_padding"] = has_any ? Json(examined.with_padding.maximum) : Json();
  json["mean_with_padding"] = has_any ? Json(examined.with_padding.mean) : Json();
  json["usable"] = s.usable;
  json["warnings"] = s.warnings;
  return json;
}

// "series 4 of 20260104 at 101500, CHEST, axial, kernel B30f, 1 mm thick, "; empty if nothing is said.
std::string details_of(const io::Series& s) {
  const io::Series::Details& d = s.details;
  std::string text;
  const auto add = [&](const std::string& what) { text += what + ", "; };
  if (d.number) add(fmt::format("series {}", *d.number));
  if (!d.date.empty()) add(d.time.empty() ? d.date : fmt::format("{} at {}", d.date, d.time.substr(0, 6)));
  if (!d.body_part.empty()) add(d.body_part);
  if (!d.orientation.empty()) add(d.orientation);
  if (!d.kernel.empty()) add("kernel " + d.kernel);
  if (!d.sequence.empty()) add("sequence " + d.sequence);
  if (!d.contrast.empty()) add("contrast " + d.contrast);
  if (d.thickness_mm > 0) add(fmt::format("{:.3g} mm thick", d.thickness_mm));
  return text;
}

void print_text(std::size_t number, const Examined& examined, bool patient) {
  const io::Series& s = examined.series;
  const io::Geometry& g = s.geometry;
  const auto triple = [](const glm::dvec3& v) { return fmt::format("{:.6g}, {:.6g}, {:.6g}", v.x, v.y, v.z); };
  std::string text = describe_series(number, s, examined.name) + "\n";
  if (patient) {
    text += fmt::format("   patient {}, id {}, study of {}\n", s.identity.patient_name, s.identity.patient_id,
                        s.identity.study_date);
  }
  const std::string about = details_of(s);
  text += fmt::format("   {}{} file{}\n", about, s.files.size(), s.files.size() == 1 ? "" : "s");
  if (!g.slice_positions.empty()) {
    text += fmt::format("   first voxel at {} mm; along a row {}; along a column {}; from slice to slice {} mm{}\n",
                        triple(g.slice_positions.front()), triple(g.direction_i), triple(g.direction_j), triple(g.step),
                        g.uniform ? "" : " on average");
  }
  if (examined.values.count > 0) {
    text += fmt::format("   values {:.6g} to {:.6g}, mean {:.6g}{}{}\n", examined.values.minimum,
                        examined.values.maximum, examined.values.mean, s.unit.empty() ? "" : " ", s.unit);
  }
  for (std::size_t f = 0; f < s.frame_names.size(); ++f) {
    if (!s.frame_names[f].empty()) text += fmt::format("   frame {}: {}\n", f, s.frame_names[f]);
  }
  for (const std::string& warning : s.warnings) text += "   note: " + warning + "\n";
  put("{}", text);
}

using KindCounts = std::vector<std::pair<std::string, std::size_t>>;

/// Most first.
KindCounts count_kinds(const std::vector<io::SkippedFile>& skipped) {
  std::map<std::string, std::size_t> counts;
  for (const io::SkippedFile& file : skipped) ++counts[file.kind.empty() ? "other file" : file.kind];
  KindCounts sorted(counts.begin(), counts.end());
  std::ranges::stable_sort(sorted, std::greater(), [](const auto& kind) { return kind.second; });
  return sorted;
}

std::string counted(const std::string& kind, std::size_t count) {
  if (count == 1) return "1 " + kind;
  if (kind == "copy") return fmt::format("{} copies", count);
  if (kind == "index") return fmt::format("{} indexes", count);
  if (kind.starts_with("image that is")) return fmt::format("{} images that are no part of a volume", count);
  return fmt::format("{} {}s", count, kind);
}

// By kind; each file separately if requested, or if there is nothing else to report.
void print_skipped(const std::vector<io::SkippedFile>& skipped, bool each) {
  if (skipped.empty()) return;
  std::string kinds;
  for (const auto& [kind, count] : count_kinds(skipped)) {
    kinds += (kinds.empty() ? "" : ", ") + counted(kind, count);
    if (kind == "segmentation" || kind == "structure set") kinds += " (see palpate structures)";
  }
  put("set apart: {}{}\n", kinds, each ? "" : "; --all names them");
  if (!each) return;
  for (const io::SkippedFile& file : skipped) {
    put("   {}: {}\n", file.path.string(), file.reason);
  }
}

Json json_of(const std::vector<Examined>& all, const io::Catalogue& catalogue) {
  Json series = Json::array();
  Json velocity_fields = Json::array();
  for (const Examined& examined : all) {
    const bool joined = series.size() == catalogue.series.size();
    (joined ? velocity_fields : series).push_back(json_of(examined));
  }
  Json skipped = Json::array();
  for (const auto& file : catalogue.skipped) {
    skipped.push_back({{"path", file.path.string()}, {"reason", file.reason}});
  }
  Json summary = Json::array();
  for (const auto& [kind, count] : count_kinds(catalogue.skipped)) {
    summary.push_back({{"kind", kind}, {"count", count}});
  }
  Json json = {{"series", series}, {"skipped", skipped}, {"skipped_summary", summary}};
  if (!velocity_fields.empty()) json["velocity_fields"] = velocity_fields;
  return json;
}

// Uses the results of decoding: a series whose images cannot be decoded must not be the first choice.
std::optional<io::FirstChoice> mark_first_choice(std::vector<Examined>& all, std::size_t count) {
  std::vector<io::Series> series;
  series.reserve(count);
  for (std::size_t n = 0; n < count; ++n) series.push_back(all[n].series);
  auto first = io::choose_first(series);
  if (first) all[first->index].is_first_choice = true;
  return first;
}

void run(const InfoOptions& options) {
  const std::vector<std::filesystem::path> paths(options.paths.begin(), options.paths.end());
  const io::Catalogue catalogue = io::find_series(paths, terminal_progress("finding series"));
  std::vector<Examined> all;
  for (std::size_t n = 0; n < scan_count(catalogue); ++n) {
    all.push_back(examine(scan_at(catalogue, n), scan_name(catalogue, n)));
  }
  const auto first = mark_first_choice(all, catalogue.series.size());
  if (options.json) {
    // A file's name may be in any encoding.
    put_json(json_of(all, catalogue), 2);
  } else {
    for (std::size_t n = 0; n < all.size(); ++n) print_text(n + 1, all[n], options.patient);
    if (first && all.size() > 1) {
      put("best to feel first: {} ({})\n", first->index + 1, first->why);
    }
    print_skipped(catalogue.skipped, options.all || catalogue.series.empty());
  }
  if (catalogue.series.empty()) throw InputRefused(say("no-image-series-in-what-was-given"));
}

}  // namespace

void add_info(CLI::App& program) {
  CLI::App* command =
      program.add_subcommand("info", "Lists series with their geometry and values, and the files that were skipped");
  const auto options = std::make_shared<InfoOptions>();
  command->add_option("PATH", options->paths, "Folders (with subfolders), files, and packed studies (.zip, .tar.gz)")
      ->required();
  command->add_flag("--json", options->json, "Print JSON, in patient space (LPS, mm)");
  command->add_flag("--all", options->all,
                    "Name each file that was set apart, and the reason (text only; JSON always names them)");
  command->add_flag("--patient", options->patient,
                    "Show the patient's name and id and the date, to check that it is the right patient (text only)");
  command->callback([options] { run(*options); });
}

}  // namespace palpate::plugin
