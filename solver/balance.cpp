#include "solver/balance.h"

#include <algorithm>
#include <cmath>

#include "solver/certify.h"
#include "solver/messages.h"

namespace palpate::solver {

namespace {

std::optional<double> find_not_finite(const Vec3& v) {
  for (const double component : {v.x, v.y, v.z}) {
    if (!std::isfinite(component)) {
      return component;
    }
  }
  return std::nullopt;
}

double largest_component(const Vec3& v) {
  return std::max({std::abs(v.x), std::abs(v.y), std::abs(v.z)});
}

std::optional<Rejection> check_position(const Vec3& v, std::size_t primitive, Field field) {
  if (const auto bad = find_not_finite(v)) {
    return Rejection{primitive, field, Flaw::not_finite, *bad};
  }
  if (largest_component(v) > largest_quantity) {
    return Rejection{primitive, field, Flaw::out_of_range, largest_component(v)};
  }
  return std::nullopt;
}

std::optional<Rejection> check_direction(const Vec3& v, std::size_t primitive) {
  if (const auto bad = find_not_finite(v)) {
    return Rejection{primitive, Field::direction, Flaw::not_finite, *bad};
  }
  const double size = largest_component(v);
  if (size < 1 / largest_quantity) {
    return Rejection{primitive, Field::direction, Flaw::zero_direction, size};
  }
  if (size > largest_quantity) {
    return Rejection{primitive, Field::direction, Flaw::out_of_range, size};
  }
  return std::nullopt;
}

std::optional<Rejection> check_strength(const Primitive& primitive, std::size_t index) {
  const double s = primitive.strength;
  const bool may_be_hard = primitive.type != PrimitiveType::directed_force;
  if (std::isnan(s) || (std::isinf(s) && s > 0 && !may_be_hard)) {
    return Rejection{index, Field::strength, Flaw::not_finite, s};
  }
  if (s < 0) {
    return Rejection{index, Field::strength, Flaw::negative, s};
  }
  if (std::isfinite(s) && s > largest_quantity) {
    return Rejection{index, Field::strength, Flaw::out_of_range, s};
  }
  return std::nullopt;
}

std::optional<Rejection> check_primitive(const Primitive& primitive, std::size_t index) {
  if (const auto rejection = check_strength(primitive, index)) {
    return rejection;
  }
  if (primitive.type != PrimitiveType::directed_force) {
    if (const auto rejection = check_position(primitive.position, index, Field::position)) {
      return rejection;
    }
  }
  if (primitive.type != PrimitiveType::point) {
    return check_direction(primitive.direction, index);
  }
  return std::nullopt;
}

std::string in_words(Field field) {
  switch (field) {
    case Field::stiffness:
      return "stiffness";
    case Field::probe:
      return "probe";
    case Field::previous_proxy:
      return "previous proxy";
    case Field::strength:
      return "strength";
    case Field::position:
      return "position";
    case Field::direction:
      return "direction";
  }
  return "field";
}

std::string in_words(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

}  // namespace

Vec3 coupling_force(const Balance& balance, const Vec3& proxy) {
  return (proxy - balance.probe) * balance.stiffness;
}

Vec3 residual(const Balance& balance, const Vec3& proxy) {
  Vec3 sum = -coupling_force(balance, proxy);
  for (const Primitive& primitive : balance.primitives) {
    sum += force_on(primitive, proxy);
  }
  return sum;
}

std::optional<Rejection> validate(const Balance& balance) {
  const double k = balance.stiffness;
  if (!std::isfinite(k)) {
    return Rejection{Rejection::whole_balance, Field::stiffness, Flaw::not_finite, k};
  }
  if (k <= 0) {
    return Rejection{Rejection::whole_balance, Field::stiffness, Flaw::not_positive, k};
  }
  if (k < smallest_stiffness || k > largest_quantity) {
    return Rejection{Rejection::whole_balance, Field::stiffness, Flaw::out_of_range, k};
  }
  if (const auto rejection = check_position(balance.probe, Rejection::whole_balance, Field::probe)) {
    return rejection;
  }
  if (const auto rejection = check_position(balance.previous_proxy, Rejection::whole_balance, Field::previous_proxy)) {
    return rejection;
  }
  for (std::size_t i = 0; i < balance.primitives.size(); ++i) {
    if (const auto rejection = check_primitive(balance.primitives[i], i)) {
      return rejection;
    }
  }
  return std::nullopt;
}

Text describe(const Rejection& rejection) {
  const std::string value = in_words(rejection.value);
  const std::string field = in_words(rejection.field);
  Text text;
  switch (rejection.flaw) {
    case Flaw::not_finite:
      text = say("not-finite", field, value);
      break;
    case Flaw::negative:
      text = say("is-negative", field, value);
      break;
    case Flaw::not_positive:
      text = say("not-positive", field, value);
      break;
    case Flaw::zero_direction:
      text = say("no-length", field, value);
      break;
    case Flaw::incompatible:
      text = say("no-point-meets-it", value, in_words(hard_tolerance));
      break;
    case Flaw::out_of_range:
      text = say("out-of-range", field, value, in_words(largest_quantity),
                 rejection.field == Field::stiffness ? ", at least " + in_words(smallest_stiffness) : "");
      break;
  }
  if (rejection.primitive == Rejection::whole_balance) {
    return text;
  }
  return at_place("primitive " + std::to_string(rejection.primitive), text);
}

}  // namespace palpate::solver
