// SPDX-License-Identifier: Apache-2.0
#include "server/cli/doctor/checks.h"

#include <curl/curl.h>
#include <fmt/format.h>

#include <cmath>
#include <ctime>
#include <nlohmann/json.hpp>

#include "server/remote/remote_server.h"

namespace vitrine::server {
namespace {

using Json = nlohmann::json;

// Sends requests to a server as visitors do, through all proxies on the way.
class Probe {
 public:
  // `origin` has no slash at its end, as in "https://museum.example". It may include a path under
  // which a proxy offers the server.
  explicit Probe(std::string origin) : origin_(std::move(origin)) {}

  Expected<RemoteAnswer> ask(const std::string& target, std::vector<std::string> fields = {},
                             const std::string& method = "GET") {
    return server_.ask(request(target, std::move(fields), method));
  }
  Expected<std::string> upgrade(const std::string& target, std::vector<std::string> fields) {
    return server_.upgrade(request(target, std::move(fields), "GET"));
  }

 private:
  RemoteRequest request(const std::string& target, std::vector<std::string> fields,
                        const std::string& method) const {
    constexpr std::chrono::seconds kTimeout{10};
    return {.method = method,
            .url = origin_ + target,
            .fields = std::move(fields),
            .timeout = kTimeout,
            .deadline = kTimeout};
  }

  const std::string origin_;
  RemoteServer server_;
};

Finding of_error(std::string check, const Error& error) {
  const std::size_t cut = error.message.rfind("; ");
  return {Verdict::kFail, std::move(check), error.message.substr(0, cut),
          cut == std::string::npos ? "see the log of the server" : error.message.substr(cut + 2)};
}

bool is_of_this_machine(const std::string& url) {
  return url.starts_with("http://127.") || url.starts_with("http://localhost") ||
         url.starts_with("http://[::1]");
}

Finding check_certificate(const std::string& url, const RemoteAnswer& answer) {
  if (!url.starts_with("https://")) {
    if (is_of_this_machine(url))
      return {Verdict::kOk, "certificate", "not needed on this machine", ""};
    return {Verdict::kWarn, "certificate",
            "the connection is not encrypted: others can read tokens",
            "set up TLS in the daemon or in a proxy"};
  }
  if (!answer.certificate_days) return {Verdict::kOk, "certificate", "valid", ""};
  const std::string detail = fmt::format("valid for {:.0f} days", *answer.certificate_days);
  constexpr double kSoon = 21;
  if (*answer.certificate_days > kSoon) return {Verdict::kOk, "certificate", detail, ""};
  return {Verdict::kWarn, "certificate", detail, "renew it, and check the automatic renewal"};
}

Finding check_date(const RemoteAnswer& answer) {
  constexpr double kApart = 5;  // largest accepted difference between the clocks, in seconds
  const std::time_t theirs = curl_getdate(answer.field("date").c_str(), nullptr);
  if (theirs < 0)
    return {Verdict::kWarn, "server clock", "the answer has no Date field",
            "let the proxy pass the Date field"};
  const double apart = std::fabs(std::difftime(theirs, std::time(nullptr)));
  const std::string detail = fmt::format("{:.0f} s from this machine's", apart);
  if (apart <= kApart) return {Verdict::kOk, "server clock", detail, ""};
  return {Verdict::kWarn, "server clock", detail, "synchronise both clocks"};
}

Finding check_cors(Probe& probe) {
  const std::vector<std::string> fields = {"Origin: https://elsewhere.example",
                                           "Access-Control-Request-Method: GET",
                                           "Access-Control-Request-Headers: range"};
  const auto read = probe.ask("/api/v1/models", {fields[0]});
  const auto asked = probe.ask("/api/v1/models", fields, "OPTIONS");
  if (!read || !asked) return of_error("cors", read ? asked.error() : read.error());
  const bool open = read->field("access-control-allow-origin") == "*" &&
                    asked->field("access-control-allow-origin") == "*" && asked->status == 204;
  if (open) return {Verdict::kOk, "cors", "pages of other sites can read public models", ""};
  return {Verdict::kFail, "cors", "pages of other sites cannot read public models",
          "let the proxy pass OPTIONS requests and Access-Control fields as they are"};
}

Finding check_validators(Probe& probe, const std::string& target) {
  const auto first = probe.ask(target);
  if (!first) return of_error("etag", first.error());
  const std::string tag = first->field("etag");
  const auto again = probe.ask(target, {"If-None-Match: " + tag});
  if (!again) return of_error("etag", again.error());
  if (!tag.empty() && !tag.starts_with("W/") && again->status == 304)
    return {Verdict::kOk, "etag", "unchanged content is not sent again", ""};
  return {Verdict::kWarn, "etag", "unchanged content is sent again",
          "switch off compression in the proxy for /api/v1: it weakens entity tags"};
}

Finding check_range(Probe& probe, const std::string& file) {
  const auto part = probe.ask(file, {"Range: bytes=0-3"});
  if (!part) return of_error("range", part.error());
  if (part->status == 206 && part->body.size() == 4 &&
      part->field("content-range").starts_with("bytes 0-3/"))
    return {Verdict::kOk, "range", "parts of files are served", ""};
  return {Verdict::kWarn, "range", fmt::format("a range request gets status {}", part->status),
          "let the proxy pass the Range field; viewers that load whole files need it"};
}

Finding check_caching(Probe& probe, const std::string& chunk) {
  const auto answer = probe.ask(chunk);
  if (!answer) return of_error("caching", answer.error());
  if (answer->field("cache-control").find("immutable") != std::string::npos)
    return {Verdict::kOk, "caching", "clients may cache chunks for a year", ""};
  return {Verdict::kWarn, "caching", "clients fetch chunks again at each visit",
          "let the proxy pass Cache-Control as it is"};
}

Finding check_websocket(Probe& probe, const std::string& stream) {
  // Uses the example key of [RFC6455] section 1.3, because the RFC also states the correct response
  // to it.
  const auto head = probe.upgrade(
      stream, {"Connection: Upgrade", "Upgrade: websocket", "Sec-WebSocket-Version: 13",
               "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==", "Sec-WebSocket-Protocol: pmesh.v1"});
  if (head && head->starts_with("HTTP/1.1 101") &&
      head->find("s3pPLMBiTxaQ9kYGzzhZRbK+xOo=") != std::string::npos)
    return {Verdict::kOk, "websocket", "streams open", ""};
  const std::string answer =
      head ? fmt::format("\"{}\"", head->substr(0, head->find('\r'))) : std::string("nothing");
  return {Verdict::kFail, "websocket", "a stream request gets " + answer,
          "let the proxy pass Upgrade and Connection (nginx: proxy_http_version 1.1)"};
}

Findings check_scanners(Probe& probe, const std::string& token) {
  const auto answer = probe.ask("/api/v1/scanners", {"Authorization: Bearer " + token});
  if (!answer) return {of_error("scanner", answer.error())};
  const Json json = Json::parse(answer->body, nullptr, false);
  if (answer->status != 200 || !json.is_object() || !json.contains("scanners")) {
    return {{Verdict::kFail, "scanner",
             fmt::format("the list of scanners gets status {}", answer->status),
             "give a token of role viewer or higher"}};
  }
  Findings findings;
  for (const Json& scanner : json["scanners"]) {
    const std::string name = scanner.value("name", ""), state = scanner.value("state", "");
    const auto problem = scanner.find("problem");
    if (problem == scanner.end() || !problem->is_string()) {
      findings.push_back({Verdict::kOk, "scanner", fmt::format("{} is {}", name, state), ""});
    } else {
      findings.push_back(
          of_error("scanner", {ErrorCode::kIo, name + ": " + problem->get<std::string>()}));
    }
  }
  if (findings.empty()) return {{Verdict::kOk, "scanner", "no scanner is configured", ""}};
  return findings;
}

// Adds the findings of the checks that need a published model.
void check_model(Probe& probe, const RemoteAnswer& list, Findings& findings) {
  const Json models = Json::parse(list.body, nullptr, false);
  const bool any = models.is_object() && models.contains("models") && !models["models"].empty();
  if (!any) {
    findings.push_back({Verdict::kWarn, "model",
                        "no model is published: ranges, caching and streams "
                        "are not checked",
                        "publish a model and run the doctor again"});
    return;
  }
  const Json links = models["models"][0].value("links", Json::object());
  const std::string self = links.value("self", "");
  findings.push_back(check_validators(probe, self + "/manifest"));
  findings.push_back(check_range(probe, self + "/file.pmesh"));
  const auto manifest = probe.ask(self + "/manifest");
  const Json json = manifest ? Json::parse(manifest->body, nullptr, false) : Json();
  if (json.is_object() && json.contains("base"))
    findings.push_back(check_caching(probe, "/api/v1/chunks/" + json["base"].value("sha256", "")));
  findings.push_back(check_websocket(probe, self + "/stream"));
}

}  // namespace

Findings check_server(const std::string& url, const std::string& token) {
  std::string origin = url;
  while (origin.ends_with('/'))
    origin.pop_back();
  Probe probe(origin);
  const auto list = probe.ask("/api/v1/models?limit=1");
  if (!list) return {of_error("server", list.error())};
  if (list->status != 200) {
    return {{Verdict::kFail, "server",
             fmt::format("the list of models gets status {}", list->status),
             "check the address and the target of the proxy"}};
  }
  Findings findings = {{Verdict::kOk, "server", "answers at " + origin, ""},
                       check_certificate(origin, *list),
                       check_date(*list),
                       check_cors(probe)};
  check_model(probe, *list, findings);
  if (!token.empty()) {
    for (Finding& finding : check_scanners(probe, token))
      findings.push_back(std::move(finding));
  }
  return findings;
}

}  // namespace vitrine::server
