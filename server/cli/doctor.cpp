// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>

#include "server/cli/command.h"
#include "server/cli/console.h"
#include "server/cli/place.h"
#include "server/doctor/check_data.h"
#include "server/doctor/check_machine.h"
#include "server/doctor/check_server.h"
#include "server/doctor/check_services.h"

namespace vitrine::cli {
namespace {

constexpr std::string_view kVerdicts[] = {"ok", "warn", "fail"};

std::string_view name_of(Verdict verdict) {
  return kVerdicts[static_cast<std::size_t>(verdict)];
}

Outcome show_json(const Findings& findings, bool well) {
  auto checks = nlohmann::json::array();
  for (const Finding& finding : findings) {
    checks.push_back({{"verdict", name_of(finding.verdict)},
                      {"check", finding.check},
                      {"detail", finding.detail},
                      {"advice", finding.advice.empty() ? nlohmann::json(nullptr)
                                                        : nlohmann::json(finding.advice)}});
  }
  return print_json({{"ok", well}, {"checks", std::move(checks)}});
}

Outcome show_lines(const Findings& findings) {
  std::string text;
  for (const Finding& finding : findings) {
    text += fmt::format("{}{:<5} {:<12} {}{}{}", text.empty() ? "" : "\n", name_of(finding.verdict),
                        finding.check, finding.detail, finding.advice.empty() ? "" : "; ",
                        finding.advice);
  }
  return print(text);
}

Outcome examine(const Arguments& arguments) {
  if (arguments.has("--token") && !arguments.has("--url"))
    return misused("--token goes with --url; name the server");
  Findings findings = check_machine();
  const auto add = [&](const Findings& more) {
    findings.insert(findings.end(), more.begin(), more.end());
  };
  if (arguments.has("--data")) {
    const auto place = place_of(arguments.text("--data"));
    if (!place) return failed(place.error());
    const bool is_in_folder = place->store.empty() && place->catalogue.empty();
    add(is_in_folder ? check_data(place->folder) : check_services(*place));
  }
  if (arguments.has("--url")) add(check_server(arguments.text("--url"), arguments.text("--token")));
  const auto failures = std::ranges::count(findings, Verdict::kFail, &Finding::verdict);
  const Outcome shown =
      arguments.has("--json") ? show_json(findings, failures == 0) : show_lines(findings);
  if (!shown || failures == 0) return shown;
  return failed(
      fmt::format("{} of {} checks failed; do what their lines say", failures, findings.size()));
}

constexpr Flag kDoctorFlags[] = {
    {"--url", "URL", "the address that visitors use"},
    {"--token", "T", "with --url: looks at the scanners, too; of the role viewer or more"},
    {"--data", "DIR|FILE", "a data folder on this machine, or the configuration file of a daemon"},
    {"--json", "", "print one JSON object: ok, and checks with verdict, detail and advice"}};

}  // namespace

const Command kDoctor = {"doctor",
                         "Looks for what keeps a server from serving well and says what to do.",
                         {},
                         kDoctorFlags,
                         examine};

}  // namespace vitrine::cli
