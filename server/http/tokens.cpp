// SPDX-License-Identifier: Apache-2.0
// Who may call, for administrators.
#include <algorithm>
#include <nlohmann/json.hpp>

#include "server/auth/role.h"
#include "server/http/handlers.h"
#include "server/http/job_json.h"
#include "server/http/published.h"
#include "server/http/timestamp.h"

namespace vitrine {
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

Response list_tokens(const Request& request, Services& services) {
  const auto page = read_page(request);
  if (!page) return page.error();
  const auto tokens = services.catalogue.tokens();
  if (!tokens) return internal_error(tokens.error(), request, services);
  auto first = tokens->begin();
  if (page->after) first = std::ranges::upper_bound(*tokens, *page->after, {}, &TokenRecord::id);
  const auto last = std::ranges::next(first, page->limit, tokens->end());
  nlohmann::ordered_json json = {{"tokens", nlohmann::ordered_json::array()}, {"next", nullptr}};
  for (auto token = first; token != last; ++token)
    json["tokens"].push_back(token_json(*token));
  if (last != tokens->end()) json["next"] = std::prev(last)->id.to_string();
  return json_answer(json);
}

Response add_token(const Request& request, Services& services) {
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

Response revoke_token(const Request& request, Services& services) {
  const auto revoked = services.catalogue.revoke_token(request.parameters.id);
  if (!revoked && revoked.error().code == ErrorCode::kState)
    return problem(404, "there is no such token in force", request.id);
  if (!revoked) return refused(revoked.error(), request, services);
  services.tokens.forget();
  Response response;
  response.status = 204;
  return response;
}

}  // namespace vitrine
