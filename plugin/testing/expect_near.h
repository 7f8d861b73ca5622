#pragma once

/// Numbers of JSON, compared one by one.

#include <gtest/gtest.h>

#include <cstddef>
#include <nlohmann/json.hpp>
#include <string>

namespace palpate::plugin::testing {

inline void expect_near(const nlohmann::json& a, const nlohmann::json& b, double tolerance, const std::string& what) {
  ASSERT_EQ(a.size(), b.size()) << what;
  for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i].get<double>(), b[i].get<double>(), tolerance) << what;
}

}  // namespace palpate::plugin::testing
