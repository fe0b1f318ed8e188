// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <new>
#include <nlohmann/json.hpp>

#include "server/cli/commands/command.h"
#include "server/cli/support/console.h"
#include "server/config/help_text.h"

namespace vitrine::server::cli {
namespace {

constexpr std::array kCommands = {&kBuild,   &kInfo,   &kDecode,    &kVerify,  &kMeasure,
                                  &kPublish, &kFetch,  &kCalibrate, &kScan,    &kReprocess,
                                  &kFuse,    &kToken,  &kBackup,    &kRestore, &kRepair,
                                  &kMigrate, &kDoctor, &kCompletion};

std::string flag_usage(const Flag& flag) {
  return flag.value.empty() ? std::string(flag.name) : fmt::format("{} {}", flag.name, flag.value);
}

std::string overview() {
  std::string text =
      "Turns 3D scans into progressive meshes (.pmesh); publishes, fetches and checks them.\n\n"
      "Usage: vitrine COMMAND [ARGUMENTS]\n\n";
  constexpr std::size_t kSummaryColumn = 13;
  for (const Command* command : kCommands) {
    text += fmt::format("  {:<10} {}\n", command->name, wrapped(command->summary, kSummaryColumn));
  }
  return text +
         "\nRun 'vitrine help COMMAND' for the flags of a command, 'vitrine --version' for the "
         "version.\nThe daemon that serves models is vitrined; see 'vitrined --help'.";
}

std::string indented(std::string_view lines) {
  std::string text = "  ";
  for (const char c : lines)
    text += c == '\n' ? std::string("\n  ") : std::string(1, c);
  return text;
}

std::string usage(const Command& command) {
  std::string text =
      fmt::format("{}\n\nUsage: vitrine {}", wrapped(command.summary, 0), command.name);
  for (const std::string_view operand : command.operands)
    text += fmt::format(" {}", operand);
  text += command.flags.empty() ? "\n" : " [FLAGS]\n";
  if (!command.details.empty()) text += fmt::format("\n{}\n", wrapped(command.details, 0));
  if (!command.flags.empty()) text += "\n";
  constexpr std::size_t kHelpColumn = 36;
  for (const Flag& flag : command.flags) {
    const std::string name = "  " + flag_usage(flag);
    text += name.size() < kHelpColumn ? fmt::format("{:<{}}", name, kHelpColumn)
                                      : fmt::format("{}\n{:{}}", name, "", kHelpColumn);
    text += wrapped(flag.help, kHelpColumn) + "\n";
  }
  if (!command.examples.empty())
    text += fmt::format("\nExamples:\n{}\n", indented(command.examples));
  return text + "\nExit code: 0 success, 1 failure, 2 wrong usage.";
}

CommandOutcome unknown_command(std::string_view name) {
  std::vector<std::string_view> names;
  names.reserve(std::size(kCommands));
  for (const Command* command : kCommands)
    names.push_back(command->name);
  const std::string_view near = suggest(name, names);
  return misused(
      fmt::format("unknown command \"{}\"{}", name,
                  near.empty() ? "; see vitrine --help" : fmt::format("; did you mean {}?", near)));
}

bool asks_for_help(std::string_view word) {
  return word == "--help" || word == "-h";
}

CommandOutcome run_command(const Command& command, std::span<const std::string_view> words) {
  const auto flags_end = std::find(words.begin(), words.end(), "--");
  if (std::any_of(words.begin(), flags_end, asks_for_help)) return print(usage(command));
  const auto arguments = Arguments::parse(words, command.flags, command.operands);
  if (!arguments) {
    return misused(
        fmt::format("{}; see vitrine {} --help", arguments.error().message, command.name));
  }
  return command.run(*arguments);
}

const Command* find_command(std::string_view name) {
  const auto found = std::ranges::find(kCommands, name, &Command::name);
  return found == kCommands.end() ? nullptr : *found;
}

CommandOutcome help(std::span<const std::string_view> words) {
  if (words.empty()) return print(overview());
  const Command* command = find_command(words[0]);
  return command == nullptr ? unknown_command(words[0]) : print(usage(*command));
}

CommandOutcome dispatch(std::span<const std::string_view> words) {
  if (words.empty()) return misused("no command is given; see vitrine --help");
  if (asks_for_help(words[0]) || words[0] == "help") return help(words.subspan(1));
  if (words[0] == "--version" || words[0] == "-V") return print("vitrine " VITRINE_VERSION);
  const Command* command = find_command(words[0]);
  return command == nullptr ? unknown_command(words[0]) : run_command(*command, words.subspan(1));
}

// Runs the command, and returns a failure if it throws. Catching the exception here ensures that
// destructors run, which switch off laser and motor.
CommandOutcome dispatch_and_catch(std::span<const std::string_view> words) {
  try {
    return dispatch(words);
  } catch (const std::bad_alloc&) {
    return failed("out of memory; free some, or use a machine with more");
  } catch (const nlohmann::json::exception&) {
    return failed("the response is not the JSON of a Vitrine server; check the address");
  } catch (const std::exception& fault) {
    return failed(fmt::format("{}; try again", fault.what()));
  }
}

}  // namespace

std::span<const Command* const> commands() {
  return kCommands;
}

int run(std::span<const std::string_view> words) {
  const CommandOutcome outcome = dispatch_and_catch(words);
  if (outcome) return 0;
  if (outcome.error().exit_code != kNobodyReads) print_fault(outcome.error().message);
  return outcome.error().exit_code;
}

}  // namespace vitrine::server::cli
