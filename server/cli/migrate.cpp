// SPDX-License-Identifier: Apache-2.0
#include "server/backup/migrate.h"

#include <fmt/core.h>

#include "server/cli/command.h"
#include "server/cli/console.h"
#include "server/cli/place.h"

namespace vitrine::cli {
namespace {

Expected<MigrationReport> migrate_between(const Arguments& arguments) {
  auto from = open_existing(arguments.text("--from"));
  if (!from) return Unexpected(from.error());
  auto to = open_existing(arguments.text("--to"));
  if (!to) return Unexpected(to.error());
  return migrate(*from, *to, [](std::size_t done, std::size_t all) {
    if (done == all || done % 100 == 0) print_note(fmt::format("{} of {} files", done, all));
  });
}

Outcome migrate_installation(const Arguments& arguments) {
  if (!arguments.has("--from")) return misused("--from is missing; name what is to be migrated");
  if (!arguments.has("--to")) return misused("--to is missing; name the place to migrate to");
  const auto done = migrate_between(arguments);
  if (!done) return failed(done.error());
  if (arguments.has("--json"))
    return print_json({{"models", done->models}, {"files", done->files}, {"bytes", done->bytes}});
  return print(
      fmt::format("{} models, {} files, {} bytes", done->models, done->files, done->bytes));
}

constexpr Flag kMigrateFlags[] = {
    {"--from", "DIR|FILE", "a data folder, or the configuration file of a daemon"},
    {"--to", "DIR|FILE", "likewise, of a place that is new"},
    {"--json", "", "print one JSON object: models, files and bytes"}};

}  // namespace

const Command kMigrate = {"migrate",
                          "Moves models, tokens and jobs to another store and catalogue.",
                          {},
                          kMigrateFlags,
                          migrate_installation};

}  // namespace vitrine::cli
