// SPDX-License-Identifier: Apache-2.0
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <exception>
#include <new>
#include <nlohmann/json.hpp>

#include "server/cli/command.h"
#include "server/cli/console.h"
#include "server/config/suggest.h"

namespace vitrine::cli {
namespace {

constexpr std::array kCommands = {
    &kBuild, &kInfo,      &kDecode, &kVerify, &kMeasure, &kPublish, &kFetch,   &kCalibrate,
    &kScan,  &kReprocess, &kMerge,  &kToken,  &kBackup,  &kRestore, &kMigrate, &kDoctor};

std::string flag_usage(const Flag& flag) {
  return flag.value.empty() ? std::string(flag.name) : fmt::format("{} {}", flag.name, flag.value);
}

std::string overview() {
  std::string text =
      "Vitrine turns 3D scans into progressive meshes.\n\nusage: vitrine COMMAND ...\n\n";
  for (const Command* command : kCommands) {
    text += fmt::format("  {:<10} {}\n", command->name, command->summary);
  }
  return text + "\nvitrine COMMAND --help tells more; vitrine --version prints the version.";
}

std::string usage(const Command& command) {
  std::string text = fmt::format("{}\n\nusage: vitrine {} {} [FLAGS]\n\n", command.summary,
                                 command.name, fmt::join(command.operands, " "));
  for (const Flag& flag : command.flags) {
    text += fmt::format("  {:<33} {}\n", flag_usage(flag), flag.help);
  }
  return text + "\nExit code: 0 done, 1 failed with a reason, 2 wrong usage.";
}

Outcome unknown_command(std::string_view name) {
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

Outcome run_command(const Command& command, std::span<const std::string_view> words) {
  const auto flags_end = std::find(words.begin(), words.end(), "--");
  if (std::any_of(words.begin(), flags_end, asks_for_help)) return print(usage(command));
  const auto arguments = Arguments::parse(words, command.flags, command.operands);
  if (!arguments) {
    return misused(
        fmt::format("{}; see vitrine {} --help", arguments.error().message, command.name));
  }
  return command.run(*arguments);
}

Outcome dispatch(std::span<const std::string_view> words) {
  if (words.empty()) return misused("no command is given; see vitrine --help");
  if (asks_for_help(words[0]) || words[0] == "help") return print(overview());
  if (words[0] == "--version") return print("vitrine " VITRINE_VERSION);
  for (const Command* command : kCommands) {
    if (command->name == words[0]) return run_command(*command, words.subspan(1));
  }
  return unknown_command(words[0]);
}

// What is thrown ends the command as a fault does, and what it holds is let go on the way: a laser
// goes off.
Outcome dispatch_and_catch(std::span<const std::string_view> words) {
  try {
    return dispatch(words);
  } catch (const std::bad_alloc&) {
    return failed("memory has run out; free some, or take a machine that has more");
  } catch (const nlohmann::json::exception&) {
    return failed("what was answered is no JSON of Vitrine's; check the address");
  } catch (const std::exception& fault) {
    return failed(fmt::format("{}; try again", fault.what()));
  }
}

}  // namespace

int run(std::span<const std::string_view> words) {
  const Outcome outcome = dispatch_and_catch(words);
  if (outcome) return 0;
  if (outcome.error().exit_code != kNobodyReads) print_fault(outcome.error().message);
  return outcome.error().exit_code;
}

}  // namespace vitrine::cli
