// SPDX-License-Identifier: Apache-2.0
#include "server/backup/migrate.h"

#include <fmt/core.h>

#include "server/cli/commands/command.h"
#include "server/cli/support/audit_trail.h"
#include "server/cli/support/console.h"
#include "server/cli/support/place.h"

namespace vitrine::server::cli {
namespace {

Expected<MigrationReport> migrate_between(const Arguments& arguments) {
  auto from = open_existing(arguments.text("--from"));
  if (!from) return tl::unexpected(from.error());
  auto to = open_existing(arguments.text("--to"));
  if (!to) return tl::unexpected(to.error());
  const auto limits = storage_limits_of(arguments.text("--to"));
  if (!limits) return tl::unexpected(limits.error());
  const auto trail = AuditTrail::open(to->place.folder);
  if (!trail) return tl::unexpected(trail.error());
  const auto tell = [](std::size_t done, std::size_t all) {
    if (done == all || done % 100 == 0) print_note(fmt::format("{} of {} files", done, all));
  };
  auto report = migrate(*from, *to, tell, *limits);
  trail->record("migrate", arguments.text("--from"), report && report->damaged.empty());
  return report;
}

CommandOutcome show_migration(const MigrationReport& report, bool as_json) {
  auto damaged = nlohmann::json::array();
  std::string text;
  for (const DamagedFile& file : report.damaged) {
    damaged.push_back(to_text(file));
    text += to_text(file) + '\n';
  }
  if (as_json) {
    return print_json({{"models", report.models},
                       {"files", report.files},
                       {"bytes", report.bytes},
                       {"damaged", damaged}});
  }
  return print(text + fmt::format("{} models, {} files, {} bytes", report.models, report.files,
                                  report.bytes));
}

CommandOutcome migrate_installation(const Arguments& arguments) {
  if (!arguments.has("--from")) return misused("--from is missing; name the installation to copy");
  if (!arguments.has("--to")) return misused("--to is missing; name the destination");
  const auto done = migrate_between(arguments);
  if (!done) return failed(done.error());
  const CommandOutcome shown = show_migration(*done, arguments.has("--json"));
  if (!shown || done->damaged.empty()) return shown;
  return failed(
      fmt::format("damaged files that the destination lacks: {}; put them back with 'vitrine "
                  "repair --data {} --backup FILE'",
                  done->damaged.size(), arguments.text("--to")));
}

constexpr Flag kMigrateFlags[] = {
    {"--from", "DIR|FILE", "source: data folder, or configuration file of its daemon (required)"},
    {"--to", "DIR|FILE",
     "destination, which must be new or hold an interrupted migration: data folder, or "
     "configuration file of its daemon (required)"},
    {"--json", "", "print the result as one JSON object: models, files, bytes and damaged"}};

}  // namespace

const Command kMigrate = {
    .name = "migrate",
    .summary = "Copies models, tokens and jobs to another data folder, or bucket and database.",
    .details =
        "The source's daemon may run while files are copied, which the progress shows. The "
        "catalogue is copied last, and later changes at the source are lost, so stop that daemon "
        "before the files are complete. After an interruption, run the command again. Uploads and "
        "scan data are not copied. For a bucket or database, give a configuration file. If files "
        "are damaged, copies the rest, lists them, and ends with exit code 1.",
    .flags = kMigrateFlags,
    .examples = "vitrine migrate --from /var/lib/vitrine --to /etc/vitrine.conf",
    .run = migrate_installation};

}  // namespace vitrine::server::cli
