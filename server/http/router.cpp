// SPDX-License-Identifier: Apache-2.0
#include "server/http/router.h"

#include <algorithm>

#include "codec/core/parse_number.h"

namespace vitrine {
namespace {

bool is_lower(char c) {
  return c >= 'a' && c <= 'z';
}

bool is_name(std::string_view text) {
  const auto fits = [](char c) { return is_lower(c) || (c >= '0' && c <= '9') || c == '-'; };
  return !text.empty() && text.size() <= 32 && std::ranges::all_of(text, fits);
}

bool parse_small(std::string_view text, std::uint32_t& out) {
  if (text.empty() || text.size() > 6 || text.front() == '0') return false;
  const auto number = parse_number<std::uint32_t>(text);
  if (number) out = *number;
  return number.has_value();
}

bool parse_parameter(std::string_view kind, std::string_view text, PathParameters& out) {
  if (kind == "{id}") {
    const auto id = ModelId::parse(text);
    if (id) out.id = *id;
    return id.has_value();
  }
  if (kind == "{sha256}") return from_hex(text, out.sha256);
  if (kind == "{number}") return parse_small(text, out.number);
  if (kind == "{name}") {
    out.name = text;
    return is_name(text);
  }
  out.format = text;
  return !text.empty() && text.size() <= 8 && std::ranges::all_of(text, is_lower);
}

// Walks the template and the path together, a literal stretch or a parameter at a time.
std::optional<PathParameters> match_template(std::string_view pattern, std::string_view path) {
  PathParameters parameters;
  while (!pattern.empty()) {
    if (pattern == "{rest}") return parameters;
    if (pattern.front() == '{') {
      const std::string_view kind = pattern.substr(0, pattern.find('}') + 1);
      const std::string_view text = path.substr(0, path.find('/'));
      if (!parse_parameter(kind, text, parameters)) return std::nullopt;
      pattern.remove_prefix(kind.size());
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
    case Method::kOptions:
      break;  // of every path
  }
  return "";
}

}  // namespace

Router::Router(std::span<const Route> routes) : routes_(routes) {
  for (const Route& route : routes) {
    const auto known = std::ranges::find(templates_, route.path);
    template_of_.push_back(static_cast<std::size_t>(known - templates_.begin()));
    if (known == templates_.end()) templates_.push_back(route.path);
  }
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
  for (const Method method : {Method::kGet, Method::kPost, Method::kPatch, Method::kDelete}) {
    if (find(match, method)) methods += allowed_by(method);
  }
  return methods + "OPTIONS";
}

}  // namespace vitrine
