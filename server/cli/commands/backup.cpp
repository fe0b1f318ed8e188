// SPDX-License-Identifier: Apache-2.0
#include "server/backup/backup.h"

#include <fmt/core.h>

#include "server/cli/commands/command.h"
#include "server/cli/support/audit_trail.h"
#include "server/cli/support/console.h"
#include "server/cli/support/output.h"
#include "server/store/installation.h"

namespace vitrine::server::cli {
namespace {

CommandOutcome show_backup(const BackupReport& done, bool as_json) {
  if (as_json) {
    return print_json({{"models", done.models},
                       {"files", done.files},
                       {"bytes", done.bytes},
                       {"damaged", done.damaged}});
  }
  std::string text;
  for (const std::string& damaged : done.damaged)
    text += damaged + '\n';
  return print(text +
               fmt::format("{} models, {} files, {} bytes", done.models, done.files, done.bytes));
}

CommandOutcome report(const Expected<BackupReport>& done, const Arguments& arguments,
                      std::string_view lacking, std::string_view next_step) {
  if (!done) return failed(done.error());
  const CommandOutcome shown = show_backup(*done, arguments.has("--json"));
  if (!shown || done->damaged.empty()) return shown;
  return failed(fmt::format("damaged files that the {} lacks: {}; {}", lacking,
                            done->damaged.size(), next_step));
}

CommandOutcome back_up_folder(const Arguments& arguments) {
  if (!arguments.has("--data")) return misused("--data is missing; name the data folder");
  if (!arguments.has("-o")) return misused("-o is missing; name the backup file");
  const std::filesystem::path data = arguments.text("--data"), out = arguments.text("-o");
  if (!std::filesystem::exists(data / kCatalogueFile)) {
    return failed(fmt::format("there is no installation in {}; name the daemon's data folder",
                              data.string()));
  }
  if (const auto free = check_output(arguments, out); !free) return failed(free.error());
  return report(back_up(data, out), arguments, "backup", "put them back with 'vitrine repair'");
}

CommandOutcome restore_file(const Arguments& arguments) {
  if (!arguments.has("--data")) return misused("--data is missing; name a new or empty folder");
  const std::string data = arguments.text("--data");
  const auto restored = restore(arguments.operand(0), data);
  if (restored) {
    const auto trail = AuditTrail::open(data);
    if (!trail) return failed(trail.error());
    trail->record("restore", arguments.operand(0), true);
  }
  return report(restored, arguments, "restored folder",
                "put them back from another backup with 'vitrine repair'");
}

constexpr Flag kBackupFlags[] = {
    {"--data", "DIR", "data folder of the daemon, which may be running (required)"},
    {"-o", "FILE.tar", "backup file to write, a tar archive that ends with SHA256SUMS (required)"},
    kForceFlag,
    {"--json", "", "print the result as one JSON object: models, files, bytes and damaged"}};

constexpr std::string_view kRestoreOperands[] = {"FILE.tar"};
constexpr Flag kRestoreFlags[] = {
    {"--data", "DIR", "data folder to restore into, new or empty (required)"},
    {"--json", "", "print the result as one JSON object: models, files, bytes and damaged"}};

}  // namespace

const Command kBackup = {
    .name = "backup",
    .summary = "Writes a data folder to one backup file, also while a daemon serves it.",
    .details = "If files are damaged, leaves them out, lists them, and ends with exit code 1.",
    .flags = kBackupFlags,
    .examples =
        "vitrine backup --data /var/lib/vitrine -o vitrine.tar\n"
        "vitrine backup --data /var/lib/vitrine -o nightly.tar --force",
    .run = back_up_folder};

const Command kRestore = {
    .name = "restore",
    .summary = "Restores a data folder from a backup file and checks every hash.",
    .operands = kRestoreOperands,
    .flags = kRestoreFlags,
    .examples = "vitrine restore vitrine.tar --data /srv/new",
    .run = restore_file};

}  // namespace vitrine::server::cli
