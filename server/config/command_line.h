// SPDX-License-Identifier: Apache-2.0
// From the daemon's arguments, environment and file to its settings.
// Precedence: defaults < file < environment < flags.
#pragma once

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "server/config/settings.h"

namespace vitrine {

enum class Action { kServe, kCheckConfig, kPrintConfig, kHelp, kVersion };

struct SettingSource {
  std::string_view key;
  std::string value;
  std::string source;  // "default", "/etc/vitrine.conf:3", "VITRINE_LISTEN", "--listen"
};

struct CommandLine {
  Action action = Action::kServe;
  Settings settings;
  std::vector<SettingSource> sources;  // one per option, in the order of the table
};

// Reads a configuration file; the error names the file.
using ReadFile = std::function<Expected<std::string>(const std::string& path)>;

// `arguments` without the program's name; `environment` as "NAME=value". Every error is one line
// that names the place and, for an unknown key, the nearest known one.
Expected<CommandLine> parse_command_line(std::span<const std::string_view> arguments,
                                         std::span<const std::string_view> environment,
                                         const ReadFile& read_file);

std::string reference();                            // the text of --help
std::string print_config(const CommandLine& line);  // a commented file that gives these settings

}  // namespace vitrine
