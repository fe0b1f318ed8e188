// SPDX-License-Identifier: Apache-2.0
#include "server/messages/router.h"

#include <cassert>

namespace vitrine::server {
namespace {

std::string_view allowed_by(Method method) {
  switch (method) {
    case Method::kGet:
      return "GET, HEAD, ";
    case Method::kPost:
      return "POST, ";
    case Method::kPatch:
      return "PATCH, ";
    case Method::kDelete:
      return "DELETE, ";
    case Method::kPut:
      return "PUT, ";
    case Method::kOptions:
      break;  // OPTIONS is not listed, because every path allows it
  }
  return "";
}

}  // namespace

std::string_view PathParameters::operator[](std::string_view name) const {
  const auto used = std::span(values_).first(count_);
  const auto found = std::ranges::find(used, name, [](const auto& value) { return value.first; });
  assert(found != used.end());
  return found->second;
}

bool PathParameters::add(std::string_view name, std::string_view text) {
  if (count_ == kMost) return false;
  values_[count_++] = {name, text};
  return true;
}

Router::Router(std::vector<Route> routes, std::span<const ParameterPattern> patterns)
    : routes_(std::move(routes)), patterns_(patterns), templates_(path_templates(routes_)) {
  for (const Route& route : routes_) {
    const auto known = std::ranges::find(templates_, route.path);
    template_of_.push_back(static_cast<std::size_t>(known - templates_.begin()));
  }
}

bool Router::is_accepted(std::string_view name, std::string_view text) const {
  const auto pattern = std::ranges::find(patterns_, name, &ParameterPattern::name);
  return pattern != patterns_.end() && pattern->matches(text);
}

// Returns the parameters if `path` matches the template `pattern`, else nullopt. Matches one
// literal or parameter at a time.
std::optional<PathParameters> Router::match_template(std::string_view pattern,
                                                     std::string_view path) const {
  PathParameters parameters;
  while (!pattern.empty()) {
    if (pattern == "{rest}") return parameters;
    if (pattern.front() == '{') {
      const std::string_view name = pattern.substr(1, pattern.find('}') - 1);
      const std::string_view text = path.substr(0, path.find('/'));
      if (!is_accepted(name, text) || !parameters.add(name, text)) return std::nullopt;
      pattern.remove_prefix(name.size() + 2);
      path.remove_prefix(text.size());
    } else {
      const std::string_view literal = pattern.substr(0, pattern.find('{'));
      if (!path.starts_with(literal)) return std::nullopt;
      pattern.remove_prefix(literal.size());
      path.remove_prefix(literal.size());
    }
  }
  return path.empty() ? std::optional(parameters) : std::nullopt;
}

std::optional<RouteMatch> Router::match(std::string_view path) const {
  for (std::size_t i = 0; i < routes_.size(); ++i) {
    if (auto parameters = match_template(routes_[i].path, path)) return RouteMatch{i, *parameters};
  }
  return std::nullopt;
}

std::optional<std::size_t> Router::find(const RouteMatch& match, Method method) const {
  for (std::size_t i = match.index; i < routes_.size(); ++i) {
    if (template_of_[i] == template_of_[match.index] && routes_[i].method == method) return i;
  }
  return std::nullopt;
}

std::string Router::allow(const RouteMatch& match) const {
  std::string methods;
  for (const Method method :
       {Method::kGet, Method::kPost, Method::kPut, Method::kPatch, Method::kDelete}) {
    if (find(match, method)) methods += allowed_by(method);
  }
  return methods + "OPTIONS";
}

}  // namespace vitrine::server
