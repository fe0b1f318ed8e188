// SPDX-License-Identifier: Apache-2.0
// Prints a script that completes commands, flags and choices in bash. File names are left to bash.
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

// Returns the cases of a command: one for each flag with a value, and one for all other words.
std::string cases_of(const Command& command) {
  std::string cases, flags, operands;
  for (const Flag& flag : command.flags) {
    flags += fmt::format("{} ", flag.name);
    if (flag.value.empty()) continue;
    cases += fmt::format("    \"{} {}\") words=\"{}\" ;;\n", command.name, flag.name,
                         is_choice(flag.value) ? separated(flag.value) : "");
  }
  for (const std::string_view operand : command.operands)
    if (is_choice(operand)) operands += separated(operand) + " ";
  return cases +
         fmt::format("    \"{} \"*) words=\"{}{}--help\" ;;\n", command.name, operands, flags);
}

std::string bash_script() {
  std::string names, cases;
  for (const Command* command : commands()) {
    names += fmt::format("{} ", command->name);
    cases += cases_of(*command);
  }
  return fmt::format(R"(# Completion of vitrine for bash
_vitrine() {{
  local words="{}help" current=${{COMP_WORDS[COMP_CWORD]}}
  ((COMP_CWORD == 1)) || case "${{COMP_WORDS[1]}} ${{COMP_WORDS[COMP_CWORD - 1]}}" in
{}    *) words= ;;
  esac
  COMPREPLY=($(compgen -W "$words" -- "$current"))
}}
complete -o default -F _vitrine vitrine)",
                     names, cases);
}

constexpr std::string_view kShells[] = {"bash"};

CommandOutcome complete_in_shell(const Arguments& arguments) {
  if (arguments.operand(0) != kShells[0])
    return misused(fmt::format("no completion for {}; give bash", arguments.operand(0)));
  return print(bash_script());
}

}  // namespace

const Command kCompletion = {
    .name = "completion",
    .summary = "Prints a script that completes this program's commands and flags in a shell.",
    .operands = kShells,
    .flags = {},
    .examples = "source <(vitrine completion bash)",
    .run = complete_in_shell};

}  // namespace vitrine::server::cli
