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
  const auto trail = AuditTrail::open(to->place.folder);
  if (!trail) return tl::unexpected(trail.error());
  auto report = migrate(*from, *to, [](std::size_t done, std::size_t all) {
    if (done == all || done % 100 == 0) print_note(fmt::format("{} of {} files", done, all));
  });
  trail->record("migrate", arguments.text("--from"), report.has_value());
  return report;
}

CommandOutcome migrate_installation(const Arguments& arguments) {
  if (!arguments.has("--from")) return misused("--from is missing; name the installation to copy");
  if (!arguments.has("--to")) return misused("--to is missing; name the destination");
  const auto done = migrate_between(arguments);
  if (!done) return failed(done.error());
  if (arguments.has("--json"))
    return print_json({{"models", done->models}, {"files", done->files}, {"bytes", done->bytes}});
  return print(
      fmt::format("{} models, {} files, {} bytes", done->models, done->files, done->bytes));
}

constexpr Flag kMigrateFlags[] = {
    {"--from", "DIR|FILE", "source: data folder, or configuration file of its daemon (required)"},
    {"--to", "DIR|FILE",
     "destination, which must be new or hold an interrupted migration: data folder, or "
     "configuration file of its daemon (required)"},
    {"--json", "", "print the result as one JSON object: models, files and bytes"}};

}  // namespace

const Command kMigrate = {
    .name = "migrate",
    .summary = "Copies models, tokens and jobs to another data folder, or bucket and database.",
    .details =
        "You may start while the source's daemon runs, but stop it before the command ends: "
        "changes after the copy are lost. After an interruption, run the command again. Uploads "
        "and scan data are not copied. For a bucket or database, give a configuration file.",
    .flags = kMigrateFlags,
    .run = migrate_installation};

}  // namespace vitrine::server::cli
