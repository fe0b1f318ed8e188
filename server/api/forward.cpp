// SPDX-License-Identifier: Apache-2.0
#include "server/api/forward.h"

#include <fmt/format.h>

#include <functional>
#include <future>

#include "server/api/published.h"
#include "server/config/networks.h"
#include "server/messages/request_body.h"
#include "server/remote/remote_server.h"

namespace vitrine::server {
namespace {

constexpr const char* kForwardedField = "Vitrine-Passed-On";
constexpr std::size_t kMostBytes = 64 << 20;  // largest accepted response in bytes
// These two timeouts are short, because the daemons are on one local network.
constexpr std::chrono::seconds kConnectTimeout{3};
constexpr std::chrono::seconds kQuickTimeout{5};
// This timeout is long, because the other daemon may respond only after its turntable has stopped.
constexpr std::chrono::seconds kRevolutionTimeout{60};

std::vector<std::string> fields_of(const Request& request) {
  std::vector<std::string> fields = {fmt::format("{}: 1", kForwardedField),
                                     "Content-Type: application/json"};
  for (const char* const name : {"Authorization", "Idempotency-Key"}) {
    const auto found = request.header.find(name);
    if (found != request.header.end())
      fields.push_back(fmt::format("{}: {}", name, std::string(found->value())));
  }
  if (!request.client_address.empty())
    fields.push_back(fmt::format("X-Forwarded-For: {}", request.client_address));
  return fields;
}

// Returns the method of the forwarded request. HEAD is forwarded as GET; this server later omits
// the body when it responds to its own client.
std::string method_to_ask(const Request& request) {
  const bool is_head = request.header.method() == beast::http::verb::head;
  return is_head ? "GET" : std::string(request.header.method_string());
}

Response response_from(RemoteAnswer answer, std::string body, const Request& request) {
  Response response;
  response.status = static_cast<unsigned>(answer.status);
  response.type = answer.field("content-type");
  response.body = answer.status / 100 == 2 ? std::move(body) : std::move(answer.body);
  if (request.caller) response.caching = Caching::kPrivate;
  const std::pair<std::string_view, const char*> kept[] = {
      {"Location", "location"},
      {"Retry-After", "retry-after"},
      {"WWW-Authenticate", "www-authenticate"}};
  for (const auto& [name, key] : kept) {
    if (std::string value = answer.field(key); !value.empty())
      response.fields.emplace_back(name, std::move(value));
  }
  return response;
}

tl::expected<AdmissionLimit::Pass, AdmissionLimit::Refusal> pass_for(const Request& request,
                                                                     Services& services) {
  if (request.is_urgent) return services.forwarded_stops->admit("");
  return request.caller
             ? services.forwarded_for_callers->admit("")
             : services.forwarded_for_strangers->admit(network_of(request.client_address));
}

// Parses `text` as a JSON object. Returns null if it is not an object or is nested deeper than
// kMaxBodyDepth.
nlohmann::ordered_json object_in(const std::string& text) {
  using Json = nlohmann::ordered_json;
  const auto is_shallow = [](int depth, Json::parse_event_t, const Json&) {
    return depth <= kMaxBodyDepth;
  };
  auto json = Json::parse(text, is_shallow, /*allow_exceptions=*/false);
  return json.is_object() ? json : nullptr;
}

Response ask_daemon(const std::string& address, const Request& request, Services& services,
                    std::chrono::seconds timeout) {
  if (address.empty()) return away(request.id);
  const std::string json = request.body.empty() ? "" : request.body.dump();
  std::string body;
  RemoteServer server;
  auto answer = server.ask(
      {.method = method_to_ask(request),
       .url = fmt::format("{}{}{}{}", address, request.path, request.query.empty() ? "" : "?",
                          request.query),
       .fields = fields_of(request),
       .body = {reinterpret_cast<const std::uint8_t*>(json.data()), json.size()},
       .timeout = timeout,
       .to_connect = kConnectTimeout,
       .deadline = timeout,
       .bypasses_proxy = true,  // no proxy outside the museum's network may see the caller's token
       .take = [&](std::span<const std::uint8_t> bytes) {
         body.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
         return body.size() <= kMostBytes;
       }});
  if (!answer) return internal_error(answer.error(), request, services);
  return response_from(std::move(*answer), std::move(body), request);
}

}  // namespace

bool is_forwarded(const Request& request) {
  return request.header.find(kForwardedField) != request.header.end();
}

std::vector<nlohmann::ordered_json> ask_daemons(std::span<const DaemonQuery> queries,
                                                const Request& request, Services& services) {
  const auto ask = [&](const DaemonQuery& query) -> nlohmann::ordered_json {
    Request one = request;
    one.path = query.path;
    one.query = query.query;
    const auto answer = ask_daemon(query.address, one, services, kQuickTimeout);
    const auto* const text = std::get_if<std::string>(&answer.body);
    return answer.status == 200 && text != nullptr ? object_in(*text) : nullptr;
  };
  // All queries share one pass of the admission limit, because only one worker thread waits for
  // them.
  const auto pass = pass_for(request, services);
  if (!pass) return std::vector<nlohmann::ordered_json>(queries.size());
  std::vector<std::future<nlohmann::ordered_json>> asked;
  asked.reserve(queries.size());
  for (const DaemonQuery& query : queries)
    asked.push_back(std::async(std::launch::async, ask, std::cref(query)));
  std::vector<nlohmann::ordered_json> answers;
  answers.reserve(asked.size());
  for (auto& one : asked)
    answers.push_back(one.get());
  return answers;
}

std::optional<std::string> forward_address(const std::string& scanner, const Request& request,
                                           Services& services) {
  if (is_forwarded(request)) return std::nullopt;
  return services.scans.address_of(scanner);
}

Response forward(const std::string& address, const Request& request, Services& services) {
  const auto pass = pass_for(request, services);
  if (!pass) return away(request.id);
  return ask_daemon(address, request, services,
                    request.is_urgent ? kQuickTimeout : kRevolutionTimeout);
}

}  // namespace vitrine::server
