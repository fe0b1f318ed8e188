// SPDX-License-Identifier: Apache-2.0
// The one table of what can be configured. Flags, environment variables, the file and the reference
// text are all derived from it.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "codec/core/expected.h"
#include "server/config/settings.h"

namespace vitrine {

enum class OptionType {
  kEndpoint,
  kPath,
  kCount,
  kSeconds,
  kBytes,
  kPaths,
  kOrigins,
  kNames,
  kNetworks,
  kUrl,
  kText
};

struct Option {
  std::string_view key;  // flag --key, environment VITRINE_KEY with underscores, file "key = value"
  OptionType type;
  std::string_view default_value;
  std::string_view doc;
  bool secret;  // never printed
  // Parses and range-checks `text`; the error says what is expected.
  Expected<void> (*apply)(Settings& settings, std::string_view text);
  bool reloadable = false;  // SIGHUP takes a new value; the others wait for a new start
};

std::span<const Option> options();
const Option* find_option(std::string_view key);  // null where there is none

std::string environment_name(const Option& option);  // VITRINE_ADMIN_LISTEN
std::string_view type_name(OptionType type);         // "HOST:PORT"

}  // namespace vitrine
