// SPDX-License-Identifier: Apache-2.0
// Reads the daemon's settings from its configuration file, environment and arguments. Flags
// override the environment, the environment overrides the file, and the file overrides the
// defaults.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "server/config/settings.h"

namespace vitrine::server {

enum class Action { kServe, kCheckConfig, kPrintConfig, kHelp, kVersion };

struct SettingSource {
  std::string_view key;
  std::string value;
  // Where the value is from, such as "default", "/etc/vitrine.conf:3" or "--listen".
  std::string source;
};

struct CommandLine {
  Action action = Action::kServe;
  Settings settings;
  std::vector<SettingSource> sources;  // one per option, in the order of options()
};

// Returns the text of a configuration file. The error must name the file.
using ReadFile = std::function<Expected<std::string>(const std::string& path)>;

// Parses the settings. `arguments` does not include the program's name; an entry of `environment`
// is "NAME=value". Every error is one line that names the place of the fault. If a key is unknown,
// the error also suggests a similar known key, if any.
Expected<CommandLine> parse_command_line(std::span<const std::string_view> arguments,
                                         std::span<const std::string_view> environment,
                                         const ReadFile& read_file);

std::string reference();  // returns the help text about all settings
// Returns a commented configuration file with these settings.
std::string print_config(const CommandLine& line);

}  // namespace vitrine::server
