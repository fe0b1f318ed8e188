// SPDX-License-Identifier: Apache-2.0
// Decides which settings of a newly read configuration a running daemon can apply.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/config/command_line.h"

namespace vitrine::server {

struct Reload {
  CommandLine line;  // `current`, with new values of the reloadable keys that have changed
  std::vector<std::string_view> changed;  // keys whose new values are in `line`
  std::vector<std::string_view> waiting;  // keys whose new values need a restart
};

// Combines the current configuration with a newly read one. Fails with kBadInput if a value of
// `fresh` is invalid; the caller then keeps `current`.
Expected<Reload> reload(const CommandLine& current, const CommandLine& fresh);

// Formats a list of keys, such as "public-url, stop-timeout". Returns "nothing" for an empty list.
std::string list_keys(const std::vector<std::string_view>& keys);

}  // namespace vitrine::server
