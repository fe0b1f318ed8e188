// SPDX-License-Identifier: Apache-2.0
// What of a configuration that is read again takes effect while the daemon runs.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "server/config/command_line.h"

namespace vitrine {

struct Reload {
  CommandLine line;                       // `current`, but for the keys that have changed
  std::vector<std::string_view> changed;  // the keys whose new values are in it
  std::vector<std::string_view> waiting;  // those whose new values need a new start
};

// Fails (kBadInput) where a value of `fresh` is refused; `current` is then as good as before.
Expected<Reload> reload(const CommandLine& current, const CommandLine& fresh);

// "public-url, stop-timeout"; "nothing" where there are none.
std::string list_keys(const std::vector<std::string_view>& keys);

}  // namespace vitrine
