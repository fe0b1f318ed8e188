// SPDX-License-Identifier: Apache-2.0
#include "server/http/elsewhere.h"

#include <fmt/format.h>

#include <functional>
#include <future>

#include "server/config/networks.h"
#include "server/http/published.h"
#include "server/http/request_body.h"
#include "server/remote/remote_server.h"

namespace vitrine {
namespace {

constexpr const char* kPassedOn = "Vitrine-Passed-On";
constexpr std::size_t kMostBytes = 64 << 20;   // of a picture
constexpr std::chrono::seconds kToConnect{3};  // it is in the same building
constexpr std::chrono::seconds kGlance{5};
constexpr std::chrono::seconds kTurn{60};  // in which a table has turned, too

std::vector<std::string> fields_of(const Request& request) {
  std::vector<std::string> fields = {fmt::format("{}: 1", kPassedOn),
                                     "Content-Type: application/json"};
  for (const char* const name : {"Authorization", "Idempotency-Key"}) {
    const auto found = request.header.find(name);
    if (found != request.header.end())
      fields.push_back(fmt::format("{}: {}", name, std::string(found->value())));
  }
  if (!request.visitor.empty())
    fields.push_back(fmt::format("X-Forwarded-For: {}", request.visitor));
  return fields;
}

// What HEAD leaves out the session does.
std::string method_to_ask(const Request& request) {
  const bool is_head = request.header.method() == beast::http::verb::head;
  return is_head ? "GET" : std::string(request.header.method_string());
}

Response passed_back(RemoteAnswer answer, std::string body, const Request& request) {
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

tl::expected<Seats::Seat, Seats::Refusal> seat_for(const Request& request, Services& services) {
  if (request.urgent) return services.stops_elsewhere->take("");
  return request.caller ? services.callers_elsewhere->take("")
                        : services.strangers_elsewhere->take(network_of(request.visitor));
}

// An object that is no deeper than one from outside may be; else null.
nlohmann::ordered_json object_in(const std::string& text) {
  using Json = nlohmann::ordered_json;
  const auto is_shallow = [](int depth, Json::parse_event_t, const Json&) {
    return depth <= kMaxBodyDepth;
  };
  auto json = Json::parse(text, is_shallow, /*allow_exceptions=*/false);
  return json.is_object() ? json : nullptr;
}

Response ask_at_once(const std::string& address, const Request& request, Services& services,
                     std::chrono::seconds patience) {
  if (address.empty()) return away(request.id);
  const std::string json = request.body.empty() ? "" : request.body.dump();
  std::string body;
  RemoteServer server;
  auto answer =
      server.ask({.method = method_to_ask(request),
                  .url = fmt::format("{}{}{}{}", address, request.path,
                                     request.query.empty() ? "" : "?", request.query),
                  .fields = fields_of(request),
                  .body = {reinterpret_cast<const std::uint8_t*>(json.data()), json.size()},
                  .patience = patience,
                  .to_connect = kToConnect,
                  .deadline = patience,
                  .direct = true,  // a caller's token leaves the museum's network for nobody
                  .take = [&](std::span<const std::uint8_t> bytes) {
                    body.append(reinterpret_cast<const char*>(bytes.data()), bytes.size());
                    return body.size() <= kMostBytes;
                  }});
  if (!answer) return internal_error(answer.error(), request, services);
  return passed_back(std::move(*answer), std::move(body), request);
}

}  // namespace

bool is_passed_on(const Request& request) {
  return request.header.find(kPassedOn) != request.header.end();
}

std::vector<nlohmann::ordered_json> ask_all(std::span<const Question> questions,
                                            const Request& request, Services& services) {
  const auto ask = [&](const Question& question) -> nlohmann::ordered_json {
    Request one = request;
    one.path = question.path;
    one.query = question.query;
    const auto answer = ask_at_once(question.address, one, services, kGlance);
    const auto* const text = std::get_if<std::string>(&answer.body);
    return answer.status == 200 && text != nullptr ? object_in(*text) : nullptr;
  };
  const auto seat = seat_for(request, services);  // one: one worker waits
  if (!seat) return std::vector<nlohmann::ordered_json>(questions.size());
  std::vector<std::future<nlohmann::ordered_json>> asked;
  asked.reserve(questions.size());
  for (const Question& question : questions)
    asked.push_back(std::async(std::launch::async, ask, std::cref(question)));
  std::vector<nlohmann::ordered_json> answers;
  answers.reserve(asked.size());
  for (auto& one : asked)
    answers.push_back(one.get());
  return answers;
}

std::optional<std::string> elsewhere(const std::string& scanner, const Request& request,
                                     Services& services) {
  if (is_passed_on(request)) return std::nullopt;
  return services.scans.address_of(scanner);
}

Response ask_elsewhere(const std::string& address, const Request& request, Services& services) {
  const auto seat = seat_for(request, services);
  if (!seat) return away(request.id);
  return ask_at_once(address, request, services, request.urgent ? kGlance : kTurn);
}

}  // namespace vitrine
