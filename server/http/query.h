// SPDX-License-Identifier: Apache-2.0
// The target of a request, taken apart.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vitrine {

// The part of a request's target before and after '?', percent-encoding still in place. An absolute
// target ("http://host/path") loses its origin. Nothing where there is no path.
struct RequestTarget {
  std::string_view path, query;
};
std::optional<RequestTarget> split_target(std::string_view target);

// The parameters of a query, percent-decoded, '+' read as a space.
class Query {
 public:
  // Nothing where an escape is malformed or there are more than kMaxParameters.
  static std::optional<Query> parse(std::string_view text);

  // The first parameter that is not one of `known`.
  std::optional<std::string_view> unknown(std::span<const std::string_view> known) const;
  // The value of a parameter, the first where it is given several times.
  std::optional<std::string_view> get(std::string_view name) const;

  static constexpr std::size_t kMaxParameters = 32;

 private:
  std::vector<std::pair<std::string, std::string>> parameters_;
};

}  // namespace vitrine
