// SPDX-License-Identifier: Apache-2.0
#include <fmt/core.h>

#include "server/auth/authenticator.h"
#include "server/auth/role.h"
#include "server/cli/command.h"
#include "server/cli/console.h"
#include "server/cli/place.h"
#include "server/cli/remote_vitrine.h"

namespace vitrine::cli {
namespace {

constexpr std::string_view kActions[] = {"create", "revoke"};

// Of a server, or of a data folder.
tl::expected<nlohmann::json, Fault> make_token(const Arguments& arguments, Role role) {
  const std::string label = arguments.text("--label");
  if (arguments.has("--server")) {
    auto remote = RemoteVitrine::of(arguments);
    if (!remote) return tl::unexpected(remote.error());
    return remote->ask("POST", "/api/v1/tokens", {{"role", name_of(role)}, {"label", label}});
  }
  const auto installation = open_existing(arguments.text("--data"));
  if (!installation) return failed(installation.error());
  const auto token = create_token(*installation->catalogue, role, label);
  if (!token) return failed(token.error());
  return nlohmann::json{{"id", token->id.to_string()},
                        {"role", name_of(role)},
                        {"label", label},
                        {"token", token->text}};
}

Outcome revoke_token(const Arguments& arguments, const ModelId& id) {
  if (arguments.has("--server")) {
    auto remote = RemoteVitrine::of(arguments);
    if (!remote) return tl::unexpected(remote.error());
    const auto revoked = remote->ask("DELETE", "/api/v1/tokens/" + id.to_string());
    return revoked ? Outcome{} : tl::unexpected(revoked.error());
  }
  const auto installation = open_existing(arguments.text("--data"));
  if (!installation) return failed(installation.error());
  const auto revoked = installation->catalogue->revoke_token(id);
  return revoked ? Outcome{} : failed(revoked.error());
}

Outcome create(const Arguments& arguments) {
  if (!arguments.has("--role")) return misused("--role is missing; give viewer, operator or admin");
  if (arguments.has("--id")) return misused("--id goes with revoke; leave it out");
  const auto choice = arguments.choice("--role", kRoleNames);
  if (!choice) return tl::unexpected(choice.error());
  const auto token = make_token(arguments, *parse_role(kRoleNames[*choice]));
  if (!token) return tl::unexpected(token.error());
  if (arguments.has("--json")) return print_json(*token);
  print_note(fmt::format("token {} is shown this once; keep it where only its user can read it",
                         token->value("id", "")));
  return print(token->value("token", ""));
}

Outcome revoke(const Arguments& arguments) {
  if (arguments.has("--role") || arguments.has("--label"))
    return misused("--role and --label go with create; leave them out");
  const auto id = ModelId::parse(arguments.text("--id"));
  if (!id) return misused("--id is missing or no id; give the one that create has printed");
  if (const auto revoked = revoke_token(arguments, *id); !revoked) return revoked;
  if (!arguments.has("--json")) return print(id->to_string());
  return print_json({{"id", id->to_string()}});
}

Outcome change_tokens(const Arguments& arguments) {
  const std::string action = arguments.operand(0);
  if (action != kActions[0] && action != kActions[1])
    return misused(fmt::format("unknown action \"{}\"; give create or revoke", action));
  if (arguments.has("--data") == arguments.has("--server"))
    return misused("--data or --server is missing; name the data folder or the server, not both");
  return action == "create" ? create(arguments) : revoke(arguments);
}

constexpr std::string_view kOperands[] = {"create|revoke"};
constexpr Flag kTokenFlags[] = {
    {"--data", "DIR|FILE",
     "the data folder of the daemon, which may run, or its configuration file"},
    {"--role", "R", "create: viewer, operator or admin"},
    {"--label", "L", "create: whose token it is, for people"},
    {"--id", "ID", "revoke: the id that create has printed"},
    {"--server", "URL", "or a server: its URL"},
    {"--token", "T", "an administrator's token of the server"},
    {"--json", "", "print one JSON object: id, role, label and token"}};

}  // namespace

const Command kToken = {"token",
                        "Creates and revokes the tokens with which people call the server.",
                        kOperands, kTokenFlags, change_tokens};

}  // namespace vitrine::cli
