// SPDX-License-Identifier: Apache-2.0
// The table of all configuration options. Flags, environment variables, the file and the reference
// text are derived from it.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "codec/core/expected.h"
#include "server/config/settings.h"

namespace vitrine::server {

enum class OptionType {
  kEndpoint,
  kPath,
  kCount,
  kShare,
  kSeconds,
  kBytes,
  kPaths,
  kOrigins,
  kNames,
  kNetworks,
  kUrl,
  kUrls,
  kText,
  kAddressForm,
  kYesNo
};

struct Option {
  // The name of the option: flag --key, environment variable VITRINE_KEY (with underscores instead
  // of hyphens), and line "key = value" in the configuration file.
  std::string_view key;
  OptionType type;
  std::string_view default_value;
  std::string_view doc;
  bool is_secret = false;  // whether the value must never be printed
  // Parses `text`, checks its range and sets the member of `settings`. The error says which values
  // are valid.
  Expected<void> (*apply)(Settings& settings, std::string_view text);
  bool is_reloadable = false;  // whether SIGHUP applies a new value; other options need a restart
};

std::span<const Option> options();
const Option* find_option(std::string_view key);  // returns null if the key is unknown

std::string environment_name(const Option& option);  // returns a name such as VITRINE_ADMIN_LISTEN
std::string_view type_name(OptionType type);         // returns a text such as "HOST:PORT"

}  // namespace vitrine::server
