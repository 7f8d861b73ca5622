#include "plugin/cli/solve_json.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <glm/geometric.hpp>
#include <limits>
#include <nlohmann/json.hpp>
#include <set>
#include <span>
#include <stdexcept>
#include <string_view>
#include <vector>

#include "plugin/messages/messages.h"
#include "solver/chain.h"

namespace palpate::plugin {
namespace {

using Json = nlohmann::ordered_json;
using solver::Vec3;

/// A balance that cannot be read or solved; what() is the answer's "error".
class Refused : public Refusal {
 public:
  using Refusal::Refusal;
};

/// `where` is a primitive of the balance, or nothing.
Text in(std::string_view where, const Text& text) {
  return where.empty() ? text : at_place(where, text);
}

/// A balance with its primitives.
struct Problem {
  double stiffness = 0;
  Vec3 probe{0};
  Vec3 previous{0};
  std::vector<solver::Primitive> primitives;
};

struct Timed {
  solver::Solution solution;
  std::vector<Vec3> forces;
  std::int64_t nanoseconds = 0;
};

/// A stranger's text as far as a message needs it.
std::string shortened(const std::string& text) {
  constexpr std::size_t enough = 60;
  return text.size() <= enough ? text : text.substr(0, enough) + "...";
}

/// Reads a line. Keeps the id even if the rest cannot be read.
Json parse(std::string_view line, Json& id) {
  constexpr int deepest = 16;
  std::vector<std::set<std::string>> open;
  bool id_is_next = false;
  const auto look = [&](int depth, Json::parse_event_t event, Json& parsed) {
    using Event = Json::parse_event_t;
    if (depth > deepest) throw Refused(say("nested-more-than-deep", deepest));
    if (event == Event::value && depth == 1 && id_is_next) id = parsed;
    if (event == Event::object_start) open.emplace_back();
    if (event == Event::object_end) open.pop_back();
    if (event == Event::key) {
      const auto& key = parsed.get_ref<const std::string&>();
      // The library would silently keep the last.
      if (!open.back().insert(key).second) throw Refused(say("given-twice", shortened(key)));
      if (depth == 1) id_is_next = key == "id";
    }
    return true;
  };
  try {
    return Json::parse(line, look);
  } catch (const Json::exception& error) {
    const std::string what = error.what();
    const auto end_of_code = what.find("] ");
    throw Refused(
        say("not-json", (end_of_code == std::string::npos ? what : what.substr(end_of_code + 2)).substr(0, 300)));
  }
}

const Json& member(const Json& object, const char* key, std::string_view where) {
  const auto found = object.find(key);
  if (found == object.end()) throw Refused(in(where, say("is-missing", key)));
  return *found;
}

double number(const Json& object, const char* key, const std::string& where) {
  const Json& value = member(object, key, where);
  if (!value.is_number()) throw Refused(in(where, say("not-a-number", key)));
  return value.get<double>();
}

Vec3 vector(const Json& object, const char* key, const std::string& where) {
  const Json& value = member(object, key, where);
  if (!value.is_array() || value.size() != 3 ||
      !std::all_of(value.begin(), value.end(), [](const Json& component) { return component.is_number(); })) {
    throw Refused(in(where, say("not-an-array-of-three-numbers", key)));
  }
  return {value[0].get<double>(), value[1].get<double>(), value[2].get<double>()};
}

double strength(const Json& object, const std::string& where) {
  const Json& value = member(object, "strength", where);
  if (value == "inf") return std::numeric_limits<double>::infinity();
  if (!value.is_number()) throw Refused(in(where, say("strength-is-neither-a-number-nor-inf")));
  return value.get<double>();
}

solver::PrimitiveType type(const Json& object, const std::string& where) {
  using solver::PrimitiveType;
  const Json& value = member(object, "type", where);
  if (!value.is_string()) throw Refused(in(where, say("type-is-not-a-string")));
  const auto& name = value.get_ref<const std::string&>();
  for (const auto known :
       {PrimitiveType::directed_force, PrimitiveType::plane, PrimitiveType::line, PrimitiveType::point}) {
    if (name == name_of(known)) return known;
  }
  throw Refused(in(where, say("type-is-unknown", shortened(name))));
}

solver::Primitive primitive(const Json& json, std::size_t index) {
  const std::string where = "primitive " + std::to_string(index);
  if (!json.is_object()) throw Refused(in(where, say("not-an-object")));
  solver::Primitive result;
  result.type = type(json, where);
  result.strength = strength(json, where);
  if (result.type != solver::PrimitiveType::directed_force) result.position = vector(json, "position", where);
  if (result.type != solver::PrimitiveType::point) result.direction = vector(json, "direction", where);
  return result;
}

Problem problem_of(const Json& json) {
  if (!json.is_object()) throw Refused(say("not-a-json-object-but-of-type", json.type_name()));
  if (json.contains("id") && json["id"].is_structured()) throw Refused(say("id-is-neither-a-string-nor"));
  Problem problem;
  problem.stiffness = number(json, "stiffness", "");
  problem.probe = vector(json, "probe", "");
  problem.previous = json.contains("previous") ? vector(json, "previous", "") : problem.probe;
  const Json& primitives = member(json, "primitives", "");
  if (!primitives.is_array()) throw Refused(say("primitives-is-not-an-array"));
  for (const Json& each : primitives) problem.primitives.push_back(primitive(each, problem.primitives.size()));
  return problem;
}

/// The fastest of several solves, which all give the same answer.
template <typename Solve>
Timed timed(const SolveOptions& options, std::size_t primitives, const Solve& solve) {
  using Clock = std::chrono::steady_clock;
  Timed result{{}, std::vector<Vec3>(primitives, Vec3(0)), std::numeric_limits<std::int64_t>::max()};
  for (int i = 0; i < std::max(options.repeat, 1); ++i) {
    const auto start = Clock::now();
    result.solution = solve(std::span<Vec3>(result.forces));
    const auto time = std::chrono::duration_cast<std::chrono::nanoseconds>(Clock::now() - start);
    result.nanoseconds = std::min(result.nanoseconds, std::int64_t{time.count()});
  }
  return result;
}

Timed solve(const solver::Balance& balance, const SolveOptions& options) {
  const std::size_t count = balance.primitives.size();
  if (options.solver != nullptr) {
    const auto scratch = options.solver->make_scratch == nullptr ? nullptr : options.solver->make_scratch(count);
    return timed(options, count,
                 [&](std::span<Vec3> forces) { return options.solver->solve(balance, forces, scratch.get(), {}); });
  }
  solver::ChainOptions cold;
  cold.warm_start = false;
  cold.capacity = count;
  solver::Chain chain(cold);
  return timed(options, count, [&](std::span<Vec3> forces) { return chain.solve(balance, forces); });
}

Json finite_json_of(const Vec3& v) {
  if (!std::isfinite(v.x) || !std::isfinite(v.y) || !std::isfinite(v.z)) {
    throw Refused(say("answer-is-not-finite"));
  }
  return Json::array({v.x, v.y, v.z});
}

/// How far a plane, line or point is from being met, m.
double distance(const solver::Primitive& constraint, const Vec3& proxy) {
  const Vec3 away = constraint.position - proxy;
  if (constraint.type == solver::PrimitiveType::point) return glm::length(away);
  const double along = glm::dot(away, glm::normalize(constraint.direction));
  if (constraint.type == solver::PrimitiveType::plane) return std::max(0.0, along);
  return glm::length(away - along * glm::normalize(constraint.direction));
}

/// The reason for refusing an answer with an infinite error bound: the hard constraint farthest from it.
Text without_bound(const solver::Balance& balance, const Vec3& proxy) {
  double furthest = 0;
  std::size_t index = 0;
  for (std::size_t i = 0; i < balance.primitives.size(); ++i) {
    const solver::Primitive& primitive = balance.primitives[i];
    const double away = std::isinf(primitive.strength) ? distance(primitive, proxy) : 0;
    if (away > furthest) {
      furthest = away;
      index = i;
    }
  }
  if (furthest == 0) return say("no-answer-with-a-finite-error-bound");
  return say("hard-constraints-disagree", index, Json(furthest).dump());
}

void answer(const Problem& problem, const SolveOptions& options, Json& out) {
  const solver::Balance balance{problem.stiffness, problem.probe, problem.previous, problem.primitives};
  if (const auto rejection = validate(balance)) throw Refused(describe(*rejection));
  const auto [solution, forces, nanoseconds] = solve(balance, options);
  if (solution.outcome == solver::Outcome::refused) {
    throw Refused(describe(solution.rejection.value()));
  }
  if (solution.outcome == solver::Outcome::unsuitable) {
    throw Refused(
        say("solver-does-not-fit-this-configuration", options.solver == nullptr ? "chain" : options.solver->name));
  }
  if (!std::isfinite(solution.error_bound)) throw Refused(without_bound(balance, solution.proxy));
  out["proxy"] = finite_json_of(solution.proxy);
  out["force"] = finite_json_of(coupling_force(balance, solution.proxy));
  Json& shares = out["forces"] = Json::array();
  for (const Vec3& force : forces) shares.push_back(finite_json_of(force));
  out["solver"] = name_of(solution.solver);
  out["error_bound"] = solution.error_bound;
  out["iterations"] = solution.iterations;
  out["time_ns"] = nanoseconds;
  if (solution.outcome == solver::Outcome::capped) out["capped"] = true;
}

std::string text_of(const Json& json) {
  // A message may quote the bytes at fault, which need not be UTF-8.
  return json.dump(-1, ' ', false, Json::error_handler_t::replace);
}

SolvedLine answer_or_refusal(std::string_view line, const SolveOptions& options) {
  Json id;
  try {
    if (line.size() > longest_line) throw Refused(say("longer-than-bytes", longest_line));
    if (line.find_first_not_of(" \t\r\n") == std::string_view::npos) throw Refused(say("line-is-empty"));
    const Problem problem = problem_of(parse(line, id));
    Json out{{"id", id}};
    answer(problem, options, out);
    return {text_of(out), true};
  } catch (const Refused& refused) {
    return {text_of(Json{{"id", id}, {"error", refused.what()}}), false};
  }
}

}  // namespace

SolvedLine solve_line(std::string_view line, const SolveOptions& options) noexcept {
  try {
    return answer_or_refusal(line, options);
  } catch (const std::exception&) {
    // Everything else has been answered with its reason.
    return {R"({"id":null,"error":"out of memory"})", false};
  }
}

}  // namespace palpate::plugin
