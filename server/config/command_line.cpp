// SPDX-License-Identifier: Apache-2.0
#include "server/config/command_line.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <optional>

#include "server/config/help_text.h"
#include "server/config/options.h"

namespace vitrine::server {
namespace {

constexpr std::string_view kPrefix = "VITRINE_";

std::string_view trim(std::string_view text) {
  constexpr std::string_view kBlank = " \t\r";
  const std::size_t first = text.find_first_not_of(kBlank);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(kBlank) - first + 1);
}

Unexpected usage(std::string message) {
  return fail(ErrorCode::kBadInput, std::move(message));
}

Unexpected unknown(std::string_view place, std::string_view what,
                   std::span<const std::string_view> candidates) {
  const std::string_view near = suggest(what, candidates);
  const std::string hint =
      near.empty() ? "--help lists all options" : fmt::format("did you mean '{}'?", near);
  return usage(fmt::format("{}: unknown key '{}'; {}", place, what, hint));
}

std::string flag_name(const Option& option) {
  return fmt::format("--{}", option.key);
}

// Collects the settings given so far. A later call of set() overrides an earlier one.
class Draft {
 public:
  Draft() {
    for (const Option& option : options()) {
      sources_.push_back({option.key, std::string(option.default_value), "default"});
    }
  }

  void set(const Option& option, std::string_view value, std::string source) {
    auto& slot = sources_[static_cast<std::size_t>(&option - options().data())];
    slot.value = std::string(value);
    slot.source = std::move(source);
  }

  Expected<CommandLine> finish(Action action) && {
    CommandLine line{.action = action};
    for (std::size_t i = 0; i < sources_.size(); ++i) {
      const auto applied = options()[i].apply(line.settings, sources_[i].value);
      if (!applied) {
        return usage(
            fmt::format("{}: {}", place_of(options()[i], sources_[i]), applied.error().message));
      }
    }
    line.sources = std::move(sources_);
    return line;
  }

 private:
  // Returns the place of a setting for an error message. The name of a flag or variable already
  // contains the key. The place in a file does not, so the key is added.
  static std::string place_of(const Option& option, const SettingSource& setting) {
    if (setting.source == flag_name(option) || setting.source == environment_name(option))
      return setting.source;
    return fmt::format("{}: {}", setting.source, setting.key);
  }

  std::vector<SettingSource> sources_;
};

std::vector<std::string_view> known_keys() {
  std::vector<std::string_view> keys;
  for (const Option& option : options())
    keys.push_back(option.key);
  return keys;
}

Expected<void> read_line(std::string_view text, const std::string& place, Draft& draft) {
  const std::string_view line = trim(text);
  if (line.empty() || line.starts_with('#')) return {};
  const std::size_t equals = line.find('=');
  if (equals == std::string_view::npos) {
    return usage(fmt::format("{}: '{}' is not 'key = value'; correct the line", place, line));
  }
  const std::string_view key = trim(line.substr(0, equals));
  std::string_view value = trim(line.substr(equals + 1));
  if (value.size() >= 2 && value.front() == '"' && value.back() == '"') {
    value = value.substr(1, value.size() - 2);
  }
  const Option* option = find_option(key);
  if (option == nullptr) return unknown(place, key, known_keys());
  draft.set(*option, value, place);
  return {};
}

Expected<void> read_config(const std::string& path, const ReadFile& read_file, Draft& draft) {
  const auto text = read_file(path);
  if (!text) return tl::unexpected(text.error());
  std::string_view rest = *text;
  for (int number = 1; !rest.empty(); ++number) {
    const std::string_view line = rest.substr(0, rest.find('\n'));
    rest.remove_prefix(std::min(rest.size(), line.size() + 1));
    const auto read = read_line(line, fmt::format("{}:{}", path, number), draft);
    if (!read) return read;
  }
  return {};
}

constexpr std::array<std::string_view, 4> kOfTests{"VITRINE_MODELS", "VITRINE_FUZZ_SECONDS",
                                                   "VITRINE_CHROMIUM", "VITRINE_NO_SKIPS"};

// Whether a variable that begins with VITRINE_ is not a setting. Tests use some of these variables.
// Kubernetes sets other such variables if a service is named "vitrine".
bool is_foreign(std::string_view name, std::string_view value) {
  return std::ranges::find(kOfTests, name) != kOfTests.end() ||
         name.starts_with("VITRINE_SERVICE_") ||
         (name.starts_with("VITRINE_PORT") &&
          (name.size() > 12 ? name[12] == '_' : value.starts_with("tcp://")));
}

Expected<void> read_environment(std::span<const std::string_view> environment, Draft& draft) {
  std::vector<std::string> names;
  for (const Option& option : options())
    names.push_back(environment_name(option));
  for (const std::string_view entry : environment) {
    const std::string_view name = entry.substr(0, entry.find('='));
    const std::string_view value = entry.substr(std::min(entry.size(), name.size() + 1));
    if (!name.starts_with(kPrefix) || is_foreign(name, value)) continue;
    const auto found = std::ranges::find(names, name);
    if (found == names.end()) {
      return unknown("environment", name,
                     std::vector<std::string_view>(names.begin(), names.end()));
    }
    draft.set(options()[static_cast<std::size_t>(found - names.begin())], value, *found);
  }
  return {};
}

struct ActionFlag {
  std::string_view flag;
  Action action;
  std::string_view doc;
};
constexpr ActionFlag kActions[] = {
    {"--check-config", Action::kCheckConfig, "Check the configuration and exit."},
    {"--print-config", Action::kPrintConfig,
     "Print all settings in the --config format, and exit."},
    {"--help", Action::kHelp, "Print this text and exit."},
    {"--version", Action::kVersion, "Print the version and exit."},
};

struct Flags {
  Action action = Action::kServe;
  std::optional<std::string> config;
  std::vector<std::pair<const Option*, std::string_view>> values;
};

Unexpected unknown_flag(std::string_view flag) {
  std::vector<std::string> flags = {"--config"};
  for (const Option& option : options())
    flags.push_back(flag_name(option));
  for (const ActionFlag& action : kActions)
    flags.emplace_back(action.flag);
  return unknown("command line", flag, std::vector<std::string_view>(flags.begin(), flags.end()));
}

Expected<Flags> read_flags(std::span<const std::string_view> arguments) {
  Flags flags;
  for (std::size_t i = 0; i < arguments.size(); ++i) {
    const std::string_view flag = arguments[i].substr(0, arguments[i].find('='));
    const auto action = std::ranges::find(kActions, arguments[i], &ActionFlag::flag);
    if (action != std::end(kActions)) {
      flags.action = action->action;
      continue;
    }
    const Option* option = flag.starts_with("--") ? find_option(flag.substr(2)) : nullptr;
    if (option == nullptr && flag != "--config") return unknown_flag(flag);
    std::string_view value;
    if (flag.size() < arguments[i].size()) {
      value = arguments[i].substr(flag.size() + 1);
    } else if (++i < arguments.size()) {
      value = arguments[i];
    } else {
      return usage(fmt::format("command line: {} needs a value; give it as the next word", flag));
    }
    if (option == nullptr) {
      flags.config = std::string(value);
    } else {
      flags.values.emplace_back(option, value);
    }
  }
  return flags;
}

}  // namespace

Expected<CommandLine> parse_command_line(std::span<const std::string_view> arguments,
                                         std::span<const std::string_view> environment,
                                         const ReadFile& read_file) {
  const auto flags = read_flags(arguments);
  if (!flags) return tl::unexpected(flags.error());
  if (flags->action == Action::kHelp || flags->action == Action::kVersion) {
    return CommandLine{.action = flags->action};
  }
  Draft draft;
  if (flags->config) {
    if (const auto read = read_config(*flags->config, read_file, draft); !read) {
      return tl::unexpected(read.error());
    }
  }
  if (const auto read = read_environment(environment, draft); !read) {
    return tl::unexpected(read.error());
  }
  for (const auto& [option, value] : flags->values) {
    draft.set(*option, value, flag_name(*option));
  }
  return std::move(draft).finish(flags->action);
}

std::string reference() {
  std::string text =
      "vitrined serves progressive meshes over HTTP and WebSocket.\n\n"
      "Usage: vitrined [--config FILE] [--KEY VALUE]...\n\n"
      "A key can be set in a file (--config FILE; lines 'key = value'), in the environment\n"
      "(such as VITRINE_TLS_KEY) and as a flag (--key VALUE). Flags override the environment,\n"
      "which overrides the file. SIGHUP reads the file again and applies changes of reloadable\n"
      "keys; for other keys, the log says that a restart is needed. After an error, it changes\n"
      "nothing and logs the error. SIGUSR1 reopens the access log after its rotation.\n\n"
      "N, BYTES and SECONDS are whole numbers without a unit: 1073741824, not 1G. Do not give\n"
      "secrets as flags, because the list of processes shows flags.\n\n";
  constexpr std::size_t kIndent = 6;
  for (const Option& option : options()) {
    const std::string doc =
        fmt::format("{} Default: {}{}", option.doc,
                    option.default_value.empty() ? "empty" : option.default_value,
                    option.is_reloadable ? "; reloadable" : "");
    text += fmt::format("  --{} {}\n{:{}}{}\n", option.key, type_name(option.type), "", kIndent,
                        wrapped(doc, kIndent));
  }
  text += "\n";
  for (const ActionFlag& action : kActions) {
    text += fmt::format("  {:<16} {}\n", action.flag, action.doc);
  }
  return text;
}

std::string print_config(const CommandLine& line) {
  std::string text;
  for (const SettingSource& setting : line.sources) {
    const Option& option = *find_option(setting.key);
    text += fmt::format("# {}\n# {}; {}; from {}{}\n", option.doc, type_name(option.type),
                        environment_name(option), setting.source,
                        option.is_reloadable ? "; reloadable" : "");
    text += option.is_secret ? fmt::format("# {} is not shown\n\n", option.key)
                             : fmt::format("{} = \"{}\"\n\n", option.key, setting.value);
  }
  return text;
}

}  // namespace vitrine::server
