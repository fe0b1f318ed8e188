// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include "server/auth/authenticator.h"
#include "server/auth/role.h"
#include "server/cli/client/remote_vitrine.h"
#include "server/cli/commands/command.h"
#include "server/cli/support/access_token.h"
#include "server/cli/support/audit_trail.h"
#include "server/cli/support/console.h"
#include "server/cli/support/place.h"

namespace vitrine::server::cli {
namespace {

constexpr std::string_view kActions[] = {"create", "revoke"};

// Creates a token for a server, or for an installation on this machine.
tl::expected<nlohmann::json, Fault> make_token(const Arguments& arguments, Role role) {
  const std::string label = arguments.text("--label");
  if (arguments.has("--server")) {
    auto remote = RemoteVitrine::of(arguments);
    if (!remote) return tl::unexpected(remote.error());
    return remote->ask("POST", "/api/v1/tokens", {{"role", name_of(role)}, {"label", label}});
  }
  const auto installation = open_existing(arguments.text("--data"));
  if (!installation) return failed(installation.error());
  const auto trail = AuditTrail::open(installation->place.folder);
  if (!trail) return failed(trail.error());
  const auto token = create_token(*installation->catalogue, role, label);
  trail->record(fmt::format("token create {}", name_of(role)), token ? token->id.to_string() : "-",
                token.has_value());
  if (!token) return failed(token.error());
  return nlohmann::json{{"id", token->id.to_string()},
                        {"role", name_of(role)},
                        {"label", label},
                        {"token", token->text}};
}

CommandOutcome revoke_token(const Arguments& arguments, const TokenId& id) {
  if (arguments.has("--server")) {
    auto remote = RemoteVitrine::of(arguments);
    if (!remote) return tl::unexpected(remote.error());
    const auto revoked = remote->ask("DELETE", "/api/v1/tokens/" + id.to_string());
    return revoked ? CommandOutcome{} : tl::unexpected(revoked.error());
  }
  const auto installation = open_existing(arguments.text("--data"));
  if (!installation) return failed(installation.error());
  const auto trail = AuditTrail::open(installation->place.folder);
  if (!trail) return failed(trail.error());
  const auto revoked = installation->catalogue->revoke_token(id);
  trail->record("token revoke", id.to_string(), revoked.has_value());
  return revoked ? CommandOutcome{} : failed(revoked.error());
}

CommandOutcome create(const Arguments& arguments) {
  if (!arguments.has("--role")) return misused("--role is missing; give viewer, operator or admin");
  if (arguments.has("--id")) return misused("--id applies to revoke; leave it out");
  const auto choice = arguments.choice("--role", kRoleNames);
  if (!choice) return tl::unexpected(choice.error());
  const auto token = make_token(arguments, *parse_role(kRoleNames[*choice]));
  if (!token) return tl::unexpected(token.error());
  if (arguments.has("--json")) return print_json(*token);
  print_note(fmt::format("token {} is shown only now; keep it where only its user can read it",
                         token->value("id", "")));
  return print(token->value("token", ""));
}

CommandOutcome revoke(const Arguments& arguments) {
  if (arguments.has("--role") || arguments.has("--label"))
    return misused("--role and --label apply to create; leave them out");
  const auto id = TokenId::parse(arguments.text("--id"));
  if (!id) return misused("--id is missing or malformed; give the ID that create printed");
  if (const auto revoked = revoke_token(arguments, *id); !revoked) return revoked;
  if (!arguments.has("--json")) return print(id->to_string());
  return print_json({{"id", id->to_string()}});
}

CommandOutcome change_tokens(const Arguments& arguments) {
  const std::string action = arguments.operand(0);
  if (action != kActions[0] && action != kActions[1])
    return misused(fmt::format("unknown action \"{}\"; give create or revoke", action));
  if (arguments.has("--data") && arguments.has("--server"))
    return misused("--data and --server exclude each other; give one");
  if (!arguments.has("--data") && !arguments.has("--server"))
    return misused("the installation is missing; name it by --data or --server");
  return action == "create" ? create(arguments) : revoke(arguments);
}

constexpr std::string_view kOperands[] = {"create|revoke"};
constexpr Flag kTokenFlags[] = {
    {"--data", "DIR|FILE",
     "data folder on this machine, or configuration file of its daemon, which may be running"},
    {"--role", "viewer|operator|admin",
     "with create (required): role of the new token. A viewer reads unpublished models, an "
     "operator also publishes and scans, an admin also manages tokens"},
    {"--label", "L", "with create: note on the token's owner or purpose"},
    {"--id", "ID",
     "with revoke (required): ID that create printed; an administrator sees all IDs at /console "
     "and by GET /api/v1/tokens"},
    {"--server", "URL", "address of a server, such as https://museum.example, instead of --data"},
    {"--token", "T", "with --server: access token of role admin"},
    kTokenFileFlag,
    {"--json", "", "print the result as one JSON object: id, role, label and token"}};

}  // namespace

const Command kToken = {
    .name = "token",
    .summary = "Creates or revokes an access token of a server.",
    .details =
        "Give --data on the daemon's machine, or --server and --token anywhere "
        "else. The new token is printed once; it cannot be shown again.",
    .operands = kOperands,
    .flags = kTokenFlags,
    .examples = "vitrine token create --role operator --data /var/lib/vitrine --label Anna",
    .run = change_tokens};

}  // namespace vitrine::server::cli
