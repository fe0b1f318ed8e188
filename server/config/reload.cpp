// SPDX-License-Identifier: Apache-2.0
#include "server/config/reload.h"

#include <fmt/format.h>

#include "server/config/options.h"

namespace vitrine::server {

Expected<Reload> reload(const CommandLine& current, const CommandLine& fresh) {
  Reload result{.line = current};
  for (std::size_t i = 0; i < options().size(); ++i) {
    const Option& option = options()[i];
    if (current.sources[i].value == fresh.sources[i].value) continue;
    if (!option.is_reloadable) {
      result.waiting.push_back(option.key);
      continue;
    }
    const auto applied = option.apply(result.line.settings, fresh.sources[i].value);
    if (!applied) return tl::unexpected(applied.error());
    result.line.sources[i] = fresh.sources[i];
    result.changed.push_back(option.key);
  }
  return result;
}

std::string list_keys(const std::vector<std::string_view>& keys) {
  return keys.empty() ? "nothing" : fmt::format("{}", fmt::join(keys, ", "));
}

}  // namespace vitrine::server
