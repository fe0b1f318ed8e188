// SPDX-License-Identifier: Apache-2.0
#include "server/backup/backup.h"

#include <fmt/core.h>

#include "server/cli/commands/command.h"
#include "server/cli/support/console.h"
#include "server/store/installation.h"

namespace vitrine::server::cli {
namespace {

CommandOutcome report(const Expected<BackupReport>& done, const Arguments& arguments) {
  if (!done) return failed(done.error());
  if (arguments.has("--json"))
    return print_json({{"models", done->models}, {"files", done->files}, {"bytes", done->bytes}});
  return print(
      fmt::format("{} models, {} files, {} bytes", done->models, done->files, done->bytes));
}

CommandOutcome back_up_folder(const Arguments& arguments) {
  if (!arguments.has("--data")) return misused("--data is missing; name the data folder");
  if (!arguments.has("-o")) return misused("-o is missing; name the backup file");
  const std::filesystem::path data = arguments.text("--data");
  if (!std::filesystem::exists(data / kCatalogueFile)) {
    return failed(fmt::format("there is no installation in {}; name the daemon's data folder",
                              data.string()));
  }
  return report(back_up(data, arguments.text("-o")), arguments);
}

CommandOutcome restore_file(const Arguments& arguments) {
  if (!arguments.has("--data")) return misused("--data is missing; name a new or empty folder");
  return report(restore(arguments.operand(0), arguments.text("--data")), arguments);
}

constexpr Flag kBackupFlags[] = {
    {"--data", "DIR", "data folder of the daemon, which may be running (required)"},
    {"-o", "FILE.tar", "backup file to write, a tar archive that ends with SHA256SUMS (required)"},
    {"--json", "", "print the result as one JSON object: models, files and bytes"}};

constexpr std::string_view kRestoreOperands[] = {"FILE.tar"};
constexpr Flag kRestoreFlags[] = {
    {"--data", "DIR", "data folder to restore into, new or empty (required)"},
    {"--json", "", "print the result as one JSON object: models, files and bytes"}};

}  // namespace

const Command kBackup = {
    .name = "backup",
    .summary = "Writes a data folder to one backup file, also while a daemon serves it.",
    .flags = kBackupFlags,
    .run = back_up_folder};

const Command kRestore = {
    .name = "restore",
    .summary = "Restores a data folder from a backup file and checks every hash.",
    .operands = kRestoreOperands,
    .flags = kRestoreFlags,
    .run = restore_file};

}  // namespace vitrine::server::cli
