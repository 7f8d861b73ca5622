// palpate-faults [KIND] [--json | --markdown]: plays every event of the fault table against the fake of each device, or
// of one, and prints the force that remains in the hand. `palpate devices --faults` runs it. Exit code 1 if a goal is
// missed. --markdown prints the table of plugin/docs/safety.md.
//
// palpate-faults --random COUNT [SEED]: plays this many random sequences of events, with consecutive seeds. Prints each
// seed that breaks a law; exit code 1 if one does.

#include <cstdio>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "device/testing/fake_rigs.h"
#include "device/testing/fault_table.h"
#include "device/testing/random_faults.h"

namespace {

using namespace palpate::device;

/// "falcon" and "haply", which has two arms, choose their rigs.
bool is_chosen(std::string_view rig, std::string_view wanted) {
  return wanted.empty() || rig == wanted || (rig == "minverse" && wanted == "haply");
}

nlohmann::ordered_json to_json(const FaultRow& row) {
  nlohmann::ordered_json json{{"device", row.device},
                              {"event", row.event},
                              {"before_n", row.before_n},
                              {"largest_after_n", row.largest_after_n},
                              {"zero_taken_s", nullptr},
                              {"largest_step_n", row.largest_step_n},
                              {"ended_by", name_of(row.ended_by)},
                              {"missed", missed_goal(row)}};
  if (row.zero_taken_s) json["zero_taken_s"] = *row.zero_taken_s;
  return json;
}

void print(const FaultRow& row) {
  char zero[24] = "-";
  if (row.zero_taken_s) std::snprintf(zero, sizeof zero, "%.3f s", *row.zero_taken_s);
  const std::string missed = missed_goal(row);
  std::printf("%-17s %-35s %6.2f N %6.2f N  %-8s %6.2f N  %-9s%s\n", row.device.c_str(), row.event.c_str(),
              row.before_n, row.largest_after_n, zero, row.largest_step_n, name_of(row.ended_by),
              missed.empty() ? "" : ("MISSED: " + missed).c_str());
}

int play_random(std::uint64_t count, std::uint64_t first) {
  int broken = 0;
  for (std::uint64_t seed = first; seed < first + count; ++seed) {
    const std::string law = play_random_faults(seed);
    if (law.empty()) continue;
    ++broken;
    std::printf("seed %llu: %s\n", static_cast<unsigned long long>(seed), law.c_str());
    std::fflush(stdout);
  }
  std::printf("%llu sequences, %d broke a law\n", static_cast<unsigned long long>(count), broken);
  return broken > 0 ? 1 : 0;
}

}  // namespace

int main(int count, char** arguments) {
  if (count >= 3 && arguments[1] == std::string_view("--random")) {
    return play_random(std::stoull(arguments[2]), count > 3 ? std::stoull(arguments[3]) : 1);
  }
  bool as_json = false, as_matrix = false;
  std::string_view wanted;
  for (int n = 1; n < count; ++n) {
    if (arguments[n] == std::string_view("--json")) {
      as_json = true;
    } else if (arguments[n] == std::string_view("--markdown")) {
      as_matrix = true;
    } else {
      wanted = arguments[n];
    }
  }
  std::vector<FaultRow> rows;
  for (const char* const rig : rig_kinds()) {
    if (!is_chosen(rig, wanted)) continue;
    const std::vector<FaultRow> of_rig = fault_table(rig);
    rows.insert(rows.end(), of_rig.begin(), of_rig.end());
  }
  bool missed = false;
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  if (as_matrix) {
    std::fputs(fault_matrix(rows).c_str(), stdout);
    return 0;
  }
  if (!as_json) {
    std::printf("%-17s %-35s %8s %8s  %-8s %8s  %s\n", "device", "event", "before", "largest", "zero", "step",
                "ended by");
  }
  for (const FaultRow& row : rows) {
    missed = missed || !missed_goal(row).empty();
    as_json ? json.push_back(to_json(row)) : print(row);
  }
  if (as_json) std::puts(json.dump(1).c_str());
  return missed ? 1 : 0;
}
