// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include <algorithm>

#include "server/cli/commands/command.h"
#include "server/cli/doctor/checks.h"
#include "server/cli/support/access_token.h"
#include "server/cli/support/console.h"
#include "server/cli/support/place.h"
#include "server/metadata/text.h"

namespace vitrine::server::cli {
namespace {

constexpr std::string_view kVerdicts[] = {"ok", "warn", "fail"};

std::string_view name_of(Verdict verdict) {
  return kVerdicts[static_cast<std::size_t>(verdict)];
}

CommandOutcome show_json(const Findings& findings, bool well) {
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

CommandOutcome show_lines(const Findings& findings) {
  std::string text;
  for (const Finding& finding : findings) {
    if (!text.empty()) text += '\n';
    // Escapes control characters, because the detail may come from the server under test.
    text += as_plain_text(fmt::format("{:<5} {:<12} {}{}{}", name_of(finding.verdict),
                                      finding.check, finding.detail,
                                      finding.advice.empty() ? "" : "; ", finding.advice));
  }
  return print(text);
}

CommandOutcome examine(const Arguments& arguments) {
  if (names_token(arguments) && !arguments.has("--url"))
    return misused("--token needs --url; name the server");
  if (arguments.has("--scrub") && !arguments.has("--data"))
    return misused("--scrub needs --data; name the installation");
  Findings findings = check_machine();
  const auto add = [&](const Findings& more) {
    findings.insert(findings.end(), more.begin(), more.end());
  };
  if (arguments.has("--data")) {
    const auto place = place_of(arguments.text("--data"));
    if (!place) return failed(place.error());
    const bool is_in_folder = place->store.empty() && place->catalogue.empty();
    add(is_in_folder ? check_data(place->folder) : check_services(*place));
    if (arguments.has("--scrub")) add(check_integrity(*place));
  }
  if (arguments.has("--url")) {
    const auto token = access_token(arguments);
    if (!token) return tl::unexpected(token.error());
    add(check_server(arguments.text("--url"), *token));
  }
  const auto failures = std::ranges::count(findings, Verdict::kFail, &Finding::verdict);
  const CommandOutcome shown =
      arguments.has("--json") ? show_json(findings, failures == 0) : show_lines(findings);
  if (!shown || failures == 0) return shown;
  return failed(fmt::format("{} of {} checks failed; follow the advice in their lines", failures,
                            findings.size()));
}

constexpr Flag kDoctorFlags[] = {
    {"--url", "URL", "address of the server for visitors, such as https://museum.example"},
    {"--token", "T",
     "with --url: access token of role viewer or higher, to check the scanners, too"},
    kTokenFileFlag,
    {"--data", "DIR|FILE", "data folder on this machine, or configuration file of its daemon"},
    {"--scrub", "",
     "with --data: read all stored files and the whole catalogue, and check them for damage"},
    {"--json", "",
     "print the result as one JSON object: ok, and checks with verdict, check, detail and advice"}};

}  // namespace

const Command kDoctor = {.name = "doctor",
                         .summary = "Checks a server for problems and says how to fix them.",
                         .details =
                             "Checks the clock and limits of this machine, with --data also an "
                             "installation, and with --url also a server as visitors reach it. "
                             "Exit code 1 if a check fails; warnings do not change it.",
                         .flags = kDoctorFlags,
                         .examples =
                             "vitrine doctor --url https://museum.example --data /var/lib/vitrine\n"
                             "vitrine doctor --data /var/lib/vitrine --scrub",
                         .run = examine};

}  // namespace vitrine::server::cli
