// SPDX-License-Identifier: Apache-2.0
#include "server/backup/repair.h"

#include <fmt/core.h>

#include "server/cli/commands/command.h"
#include "server/cli/support/audit_trail.h"
#include "server/cli/support/console.h"
#include "server/cli/support/place.h"

namespace vitrine::server::cli {
namespace {

Expected<RepairReport> repair_from(const Arguments& arguments) {
  auto installation = open_existing(arguments.text("--data"));
  if (!installation) return tl::unexpected(installation.error());
  const auto limits = storage_limits_of(arguments.text("--data"));
  if (!limits) return tl::unexpected(limits.error());
  const auto trail = AuditTrail::open(installation->place.folder);
  if (!trail) return tl::unexpected(trail.error());
  const auto recorded = [&](std::string_view source, Expected<RepairReport> report) {
    trail->record("repair", source, report && report->damaged.empty());
    return report;
  };
  if (arguments.has("--backup")) {
    const std::string backup = arguments.text("--backup");
    return recorded(backup, repair(*installation, copies_in_backup(backup), limits->disk.reserve));
  }
  const std::string source = arguments.text("--from");
  const auto from = open_existing(source);
  if (!from) return tl::unexpected(from.error());
  return recorded(source,
                  repair(*installation, copies_in_store(*from->store), limits->disk.reserve));
}

nlohmann::json names_of(const std::vector<DamagedFile>& files) {
  auto names = nlohmann::json::array();
  for (const DamagedFile& damaged : files)
    names.push_back(
        {{"object", to_hex(damaged.file.file)}, {"model", damaged.file.model.to_string()}});
  return names;
}

CommandOutcome show_repair(const RepairReport& report, bool as_json) {
  if (as_json) {
    return print_json({{"objects", report.objects},
                       {"repaired", names_of(report.repaired)},
                       {"damaged", names_of(report.damaged)}});
  }
  std::string text;
  for (const DamagedFile& damaged : report.repaired)
    text += fmt::format("repaired: {}\n", to_hex(damaged.file.file));
  for (const DamagedFile& damaged : report.damaged)
    text += to_text(damaged) + '\n';
  return print(text + fmt::format("{} objects, {} repaired, {} damaged", report.objects,
                                  report.repaired.size(), report.damaged.size()));
}

CommandOutcome repair_installation(const Arguments& arguments) {
  if (!arguments.has("--data")) return misused("--data is missing; name the installation");
  if (arguments.has("--backup") == arguments.has("--from"))
    return misused("the source of intact copies is missing; give either --backup or --from");
  const auto done = repair_from(arguments);
  if (!done) return failed(done.error());
  const CommandOutcome shown = show_repair(*done, arguments.has("--json"));
  if (!shown || done->damaged.empty()) return shown;
  return failed(
      fmt::format("objects without an intact copy there: {}; try another backup, or publish "
                  "their models again",
                  done->damaged.size()));
}

constexpr Flag kRepairFlags[] = {
    {"--data", "DIR|FILE",
     "installation to repair: data folder, or configuration file of its daemon (required)"},
    {"--backup", "FILE.tar", "backup that has intact copies"},
    {"--from", "DIR|FILE",
     "another installation that has intact copies: data folder, or configuration file of its "
     "daemon"},
    {"--json", "",
     "print the result as one JSON object: objects, repaired and damaged, the last two with object "
     "and model"}};

}  // namespace

const Command kRepair = {
    .name = "repair",
    .summary =
        "Replaces damaged and missing files of models by copies from a backup or another "
        "installation.",
    .details =
        "Give either --backup or --from. Checks every object by its SHA-256; a daemon may serve "
        "the installation meanwhile. Exit code 1 if an object stays damaged.",
    .flags = kRepairFlags,
    .examples =
        "vitrine repair --data /var/lib/vitrine --backup vitrine.tar\n"
        "vitrine repair --data /etc/vitrine.conf --from /mnt/replica",
    .run = repair_installation};

}  // namespace vitrine::server::cli
