// SPDX-License-Identifier: Apache-2.0
#include "server/backup/backup.h"

#include <fmt/core.h>

#include "server/cli/command.h"
#include "server/cli/console.h"
#include "server/store/installation.h"

namespace vitrine::cli {
namespace {

Outcome report(const Expected<BackupReport>& done, const Arguments& arguments) {
  if (!done) return failed(done.error());
  if (arguments.has("--json"))
    return print_json({{"models", done->models}, {"files", done->files}, {"bytes", done->bytes}});
  return print(
      fmt::format("{} models, {} files, {} bytes", done->models, done->files, done->bytes));
}

Outcome back_up_folder(const Arguments& arguments) {
  if (!arguments.has("--data")) return misused("--data is missing; name the data folder");
  if (!arguments.has("-o")) return misused("-o is missing; name the file to write");
  const std::filesystem::path data = arguments.text("--data");
  if (!std::filesystem::exists(data / kCatalogueFile)) {
    return failed(fmt::format("there is no installation in {}; name the daemon's data folder",
                              data.string()));
  }
  return report(back_up(data, arguments.text("-o")), arguments);
}

Outcome restore_file(const Arguments& arguments) {
  if (!arguments.has("--data")) return misused("--data is missing; name a new data folder");
  return report(restore(arguments.operand(0), arguments.text("--data")), arguments);
}

constexpr Flag kBackupFlags[] = {
    {"--data", "DIR", "the daemon's data folder; it may be running"},
    {"-o", "FILE.tar", "the backup to write: tar, with SHA256SUMS at its end"},
    {"--json", "", "print one JSON object: models, files and bytes"}};

constexpr std::string_view kRestoreOperands[] = {"FILE.tar"};
constexpr Flag kRestoreFlags[] = {{"--data", "DIR", "a new or empty folder"},
                                  {"--json", "", "print one JSON object: models, files and bytes"}};

}  // namespace

const Command kBackup = {"backup",
                         "Copies an installation into one file, also while it is served.",
                         {},
                         kBackupFlags,
                         back_up_folder};

const Command kRestore = {"restore", "Makes an installation of a backup, every hash checked.",
                          kRestoreOperands, kRestoreFlags, restore_file};

}  // namespace vitrine::cli
