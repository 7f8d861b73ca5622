#include "io/dicom/torn_series.h"

#include <algorithm>
#include <array>
#include <glm/geometric.hpp>
#include <map>
#include <set>
#include <string>

#include "io/dicom/stacking.h"
#include "io/messages.h"

namespace palpate::io::internal {
namespace {

// Whether these files are slices of one stack by their places alone: one orientation, no two at one height.
bool make_up_a_stack(const std::vector<FileHeader*>& files) {
  std::vector<double> heights;
  const Placement* first = nullptr;
  for (const FileHeader* file : files) {
    if (file->planes.size() != 1 || !file->planes.front().placement) return false;
    const Placement& place = *file->planes.front().placement;
    if (first == nullptr) first = &place;
    if (!are_parallel(place, *first)) return false;
    heights.push_back(height_of(place.position, *first));
  }
  std::ranges::sort(heights);
  const double same = same_place_mm(*first);
  return std::ranges::adjacent_find(heights, [&](double a, double b) { return b - a <= same; }) == heights.end();
}

// Anonymizers have been seen that give every file a study, or a frame of reference, of its own.
void join_what_was_torn_apart(std::vector<FileHeader>& headers) {
  std::map<std::string, std::vector<FileHeader*>> by_series;
  for (FileHeader& header : headers) {
    if (!header.series.empty()) by_series[header.series + '\n' + header.identity.patient_id].push_back(&header);
  }
  struct Uid {
    std::string FileHeader::*uid;
    Text remark;
  };
  const std::array uids{Uid{&FileHeader::study, say("each-of-its-files-names-a-study")},
                        Uid{&FileHeader::frame_of_reference, say("each-of-its-files-names-a-frame")}};
  constexpr std::size_t fewest = 3;
  for (auto& [key, files] : by_series) {
    if (files.size() < fewest) continue;
    for (const Uid& one : uids) {
      std::set<std::string> different;
      for (const FileHeader* file : files) different.insert(file->*one.uid);
      if (different.size() < files.size() || different.contains("") || !make_up_a_stack(files)) continue;
      for (FileHeader* file : files) {
        file->*one.uid = files.front()->*one.uid;
        file->remarks.push_back(one.remark);
      }
    }
  }
}

// Some anonymizers leave the patient's id only in some files of a series. A blank id is replaced by that of the others,
// if they have only one id and the same name.
void fill_in_patients(std::vector<FileHeader>& headers) {
  std::map<std::string, std::vector<FileHeader*>> by_series;
  for (FileHeader& header : headers) {
    if (!header.series.empty()) by_series[header.series + '\n' + header.study].push_back(&header);
  }
  for (auto& [key, files] : by_series) {
    std::set<std::string> ids, names;
    for (const FileHeader* file : files) {
      ids.insert(file->identity.patient_id);
      names.insert(file->identity.patient_name);
    }
    names.erase("");
    if (ids.size() != 2 || !ids.contains("") || names.size() > 1) continue;
    for (FileHeader* file : files) {
      file->identity.patient_id = *ids.rbegin();  // the empty one comes first
      if (!names.empty()) file->identity.patient_name = *names.begin();
    }
  }
}

}  // namespace

bool are_parallel(const Placement& a, const Placement& b) {
  constexpr double tolerance = 1e-3;
  return glm::length(a.direction_i - b.direction_i) < tolerance &&
         glm::length(a.direction_j - b.direction_j) < tolerance;
}

void join_torn_series(std::vector<FileHeader>& headers) {
  fill_in_patients(headers);
  join_what_was_torn_apart(headers);
}

}  // namespace palpate::io::internal
