// SPDX-License-Identifier: Apache-2.0
// Parses the target of a request: path and query parameters.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace vitrine::server {

// The parts of a request's target before and after '?', still percent-encoded. split_target() drops
// the origin of an absolute target ("http://host/path"). split_target() returns nullopt if there is
// no path.
struct RequestTarget {
  std::string_view path, query;
};
std::optional<RequestTarget> split_target(std::string_view target);

// Percent-decodes a part of a path. Returns nullopt if an escape is malformed.
std::optional<std::string> decode_path(std::string_view text);

// The parameters of a query, percent-decoded. A '+' is decoded as a space.
class Query {
 public:
  // Returns nullopt if a percent escape is malformed or there are more than kMaxParameters.
  static std::optional<Query> parse(std::string_view text);

  // Returns the name of the first parameter that is not in `known`, or nullopt if `known` contains
  // all names.
  std::optional<std::string_view> unknown(std::span<const std::string_view> known) const;
  // Returns the name of the first parameter that is given several times, or nullopt.
  std::optional<std::string_view> repeated() const;
  // Returns the value of a parameter, or nullopt if it is not given. If it is given several times,
  // returns the first value.
  std::optional<std::string_view> get(std::string_view name) const;

  static constexpr std::size_t kMaxParameters = 32;

 private:
  std::vector<std::pair<std::string, std::string>> parameters_;
};

}  // namespace vitrine::server
