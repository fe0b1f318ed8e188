// SPDX-License-Identifier: Apache-2.0
// Prints a script that completes commands, flags and choices in a shell. File names are left to the
// shell.
#include <fmt/format.h>

#include <algorithm>

#include "server/cli/commands/command.h"
#include "server/cli/support/console.h"

namespace vitrine::server::cli {
namespace {

// Whether the value's description lists the possible words, such as "midpoint|pyramid".
bool is_choice(std::string_view value) {
  return value.find('|') != value.npos && std::all_of(value.begin(), value.end(), [](char c) {
           return c == '|' || (c >= 'a' && c <= 'z');
         });
}

std::string separated(std::string_view choices) {
  std::string words(choices);
  std::replace(words.begin(), words.end(), '|', ' ');
  return words;
}

// Returns the bash `case` entries of a command: one for each flag with a value, and one for all
// other words.
std::string cases_of(const Command& command) {
  std::string cases, flags, operands;
  for (const Flag& flag : command.flags) {
    flags += fmt::format("{} ", flag.name);
    if (flag.value.empty()) continue;
    cases += fmt::format("    \"{} {}\") choices=\"{}\" ;;\n", command.name, flag.name,
                         is_choice(flag.value) ? separated(flag.value) : "");
  }
  for (const std::string_view operand : command.operands)
    if (is_choice(operand)) operands += separated(operand) + " ";
  return cases +
         fmt::format("    \"{} \"*) choices=\"{}{}--help\" ;;\n", command.name, operands, flags);
}

std::string bash_script() {
  std::string names, cases;
  for (const Command* command : commands()) {
    names += fmt::format("{} ", command->name);
    cases += cases_of(*command);
  }
  return fmt::format(R"(# Completion of vitrine for bash
_vitrine() {{
  local choices="{}help" current=${{COMP_WORDS[COMP_CWORD]}}
  ((COMP_CWORD == 1)) || case "${{COMP_WORDS[1]}} ${{COMP_WORDS[COMP_CWORD - 1]}}" in
{}    *) choices= ;;
  esac
  COMPREPLY=($(compgen -W "$choices" -- "$current"))
}}
complete -o default -F _vitrine vitrine)",
                     names, cases);
}

// zsh reads completions written for bash through its module bashcompinit.
std::string zsh_script() {
  return "#compdef vitrine\nautoload -U +X bashcompinit && bashcompinit\n" + bash_script();
}

std::string fish_script() {
  std::string script = "# Completion of vitrine for fish\n", names;
  for (const Command* command : commands()) {
    names += fmt::format("{} ", command->name);
    const std::string of_command =
        fmt::format("complete -c vitrine -n '__fish_seen_subcommand_from {}'", command->name);
    for (const Flag& flag : command->flags) {
      const bool is_long = flag.name.starts_with("--");
      script += fmt::format("{} -{} {}", of_command, is_long ? 'l' : 's',
                            flag.name.substr(is_long ? 2 : 1));
      if (is_choice(flag.value))
        script += fmt::format(" -x -a '{}'", separated(flag.value));
      else if (!flag.value.empty())
        script += " -r";
      script += '\n';
    }
    for (const std::string_view operand : command->operands)
      if (is_choice(operand)) script += fmt::format("{} -a '{}'\n", of_command, separated(operand));
  }
  return script + fmt::format("complete -c vitrine -f -n __fish_use_subcommand -a '{}help'", names);
}

struct Shell {
  std::string_view name;
  std::string (*script)();
};
constexpr Shell kShells[] = {{"bash", bash_script}, {"zsh", zsh_script}, {"fish", fish_script}};
constexpr std::string_view kShellOperands[] = {"bash|zsh|fish"};

CommandOutcome complete_in_shell(const Arguments& arguments) {
  const auto* shell = std::ranges::find(kShells, arguments.operand(0), &Shell::name);
  if (shell == std::end(kShells))
    return misused(
        fmt::format("no completion for {}; give bash, zsh or fish", arguments.operand(0)));
  return print(shell->script());
}

}  // namespace

const Command kCompletion = {
    .name = "completion",
    .summary = "Prints a script that completes this program's commands and flags in a shell.",
    .operands = kShellOperands,
    .flags = {},
    .examples = "source <(vitrine completion bash)\nvitrine completion fish | source",
    .run = complete_in_shell};

}  // namespace vitrine::server::cli
