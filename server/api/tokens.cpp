// SPDX-License-Identifier: Apache-2.0
// Defines the routes with which administrators list, create and revoke tokens of the API.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "server/api/handlers.h"
#include "server/api/job_json.h"
#include "server/api/path_parameters.h"
#include "server/api/published.h"
#include "server/auth/role.h"
#include "server/messages/timestamp.h"

namespace vitrine::server {
namespace {

struct TokenOrder {
  Role role = Role::kNone;
  std::string label;
};

tl::expected<TokenOrder, FieldFaults> parse_token_order(const nlohmann::json& body) {
  constexpr std::string_view kKnown[] = {"role", "label"};
  FieldFaults faults;
  Fields fields(body, "", faults);
  TokenOrder order;
  fields.only(kKnown);
  int role = -1;
  fields.choice("role", kRoleNames, role);
  if (!body.contains("role")) fields.fault("role", "viewer, operator or admin");
  fields.text("label", order.label);
  order.role = static_cast<Role>(role + 1);
  return order_or_faults(std::move(order), std::move(faults));
}

nlohmann::ordered_json token_json(const TokenRecord& token) {
  return {{"id", token.id.to_string()},
          {"role", name_of(token.role)},
          {"label", token.label},
          {"created", timestamp(token.created)}};
}

}  // namespace

static Response list_tokens(const Request& request, Services& services) {
  const auto page = read_page<TokenId>(request);
  if (!page) return page.error();
  const auto tokens = services.catalogue.tokens();
  if (!tokens) return internal_error(tokens.error(), request, services);
  auto first = tokens->begin();
  if (page->after) first = std::ranges::upper_bound(*tokens, *page->after, {}, &TokenRecord::id);
  const auto last = std::ranges::next(first, page->limit, tokens->end());
  nlohmann::ordered_json list = nlohmann::ordered_json::array();
  for (auto token = first; token != last; ++token)
    list.push_back(token_json(*token));
  std::optional<std::string> next;
  if (last != tokens->end()) next = std::prev(last)->id.to_string();
  return list_answer("tokens", std::move(list), next, request);
}

static Response add_token(const Request& request, Services& services) {
  const auto order = parse_token_order(request.body);
  if (!order) return invalid(order.error(), request);
  const auto token = create_token(services.catalogue, order->role, order->label);
  if (!token && token.error().code == ErrorCode::kBadInput)
    return invalid({{"label", token.error().message}}, request);
  if (!token) return refused(token.error(), request, services);
  Response response = json_answer({{"id", token->id.to_string()},
                                   {"role", name_of(order->role)},
                                   {"label", order->label},
                                   {"token", token->text}},
                                  201);
  response.fields = {{"Location", "/api/v1/tokens/" + token->id.to_string()}};
  return response;
}

static Response revoke_token(const Request& request, Services& services) {
  const auto revoked = services.catalogue.revoke_token(id_in<TokenId>(request));
  if (!revoked && revoked.error().code == ErrorCode::kState)
    return problem(404, "there is no such token in force", request.id);
  if (!revoked) return refused(revoked.error(), request, services);
  services.tokens.forget();
  Response response;
  response.status = 204;
  return response;
}

static constexpr std::string_view kTokensComponents = R"json({
"schemas": {
  "RoleName": {"enum": ["viewer", "operator", "admin"]},
  "TokenOrder": {"type": "object", "required": ["role"], "additionalProperties": false, "properties": {
    "role": {"$ref": "#/components/schemas/RoleName"}, "label": {"type": "string", "description": "A note that helps to recognise the token"}}},
  "TokenPage": {"type": "object", "required": ["tokens", "next"], "properties": {"next": {"$ref": "#/components/schemas/Next"}, "tokens": {"type": "array", "items": {"type": "object",
    "required": ["id", "role", "label", "created"], "properties": {
    "id": {"$ref": "#/components/schemas/Id"}, "role": {"$ref": "#/components/schemas/RoleName"}, "label": {"type": "string"},
    "created": {"$ref": "#/components/schemas/Time"}}}}}},
  "NewToken": {"type": "object", "required": ["id", "role", "label", "token"], "properties": {
    "id": {"$ref": "#/components/schemas/Id"}, "role": {"$ref": "#/components/schemas/RoleName"}, "label": {"type": "string"},
    "token": {"type": "string", "description": "The token's text, shown in this response only"}}}
}
})json";

static constexpr ApiRoute kTokenRoutes[] = {
    {.method = Method::kGet,
     .path = "/api/v1/tokens",
     .handler = list_tokens,
     .executor = Executor::kWorker,
     .role = Role::kAdmin,
     .doc = {.id = "listTokens",
             .summary = "Lists the valid tokens, oldest first.",
             .parameters = "limit cursor",
             .response = "TokenPage"}},
    {.method = Method::kPost,
     .path = "/api/v1/tokens",
     .handler = add_token,
     .executor = Executor::kWorker,
     .role = Role::kAdmin,
     .doc = {.id = "addToken",
             .summary = "Creates a token. Its text appears in this response only.",
             .request = "TokenOrder",
             .status = 201,
             .response = "NewToken"}},
    {.method = Method::kDelete,
     .path = "/api/v1/tokens/{id}",
     .handler = revoke_token,
     .executor = Executor::kWorker,
     .role = Role::kAdmin,
     .doc =
         {.id = "revokeToken",
          .summary =
              "Revokes a token: here at once, at the installation's other daemons within 100 ms.",
          .status = 204}},
};

static constexpr ApiTag kTokensTags[] = {
    {.name = "tokens", .description = "Tokens of people and programs, with their roles."}};

const ApiNoun kTokens = {
    .routes = kTokenRoutes, .components = kTokensComponents, .tags = kTokensTags};

}  // namespace vitrine::server
