// SPDX-License-Identifier: Apache-2.0
#include "server/http/router.h"

#include <algorithm>

namespace vitrine {
namespace {

bool is_lower(char c) {
  return c >= 'a' && c <= 'z';
}

bool parse_parameter(std::string_view kind, std::string_view text, PathParameters& out) {
  if (kind == "{id}") {
    const auto id = ModelId::parse(text);
    if (id) out.id = *id;
    return id.has_value();
  }
  if (kind == "{sha256}") return from_hex(text, out.sha256);
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

}  // namespace

std::vector<std::string_view> Router::templates() const {
  std::vector<std::string_view> paths;
  for (const Route& route : routes_)
    paths.push_back(route.path);
  return paths;
}

std::optional<RouteMatch> Router::match(std::string_view path) const {
  for (std::size_t i = 0; i < routes_.size(); ++i) {
    if (auto parameters = match_template(routes_[i].path, path)) return RouteMatch{i, *parameters};
  }
  return std::nullopt;
}

}  // namespace vitrine
