// SPDX-License-Identifier: Apache-2.0
#include "server/cli/client/remote_vitrine.h"

#include <fmt/core.h>

#include <algorithm>
#include <charconv>
#include <thread>

#include "server/cli/support/access_token.h"

namespace vitrine::server::cli {
namespace {

using Json = nlohmann::json;

// Largest number of upload bytes per request, chosen because proxies limit the size of requests.
constexpr std::size_t kPiece = 16 << 20;
constexpr int kTries = 6;  // attempts per request, within 31 seconds
// interval between two queries of a job's state
constexpr std::chrono::milliseconds kBetweenLooks{250};

std::span<const std::uint8_t> body_of(const std::string& text) {
  return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// Formats the content of a problem+json response as one line, with the next step.
std::string words_of(const RemoteAnswer& answer, const std::string& origin) {
  const Json problem = Json::parse(answer.body, nullptr, /*allow_exceptions=*/false);
  if (!problem.is_object())
    return fmt::format("{} answers {}; check that it is a Vitrine server", origin, answer.status);
  std::string text = problem.value("detail", problem.value("title", ""));
  for (const Json& error : problem.value("errors", Json::array())) {
    text += fmt::format(", {}: {}", error.value("parameter", ""), error.value("detail", ""));
  }
  std::ranges::replace(text, ';', ',');
  const std::string step = answer.status == 401 || answer.status == 403
                               ? "check the token"
                               : fmt::format("request {}", problem.value("request_id", "-"));
  return fmt::format("{} answers {} ({}); {}", origin, answer.status, text, step);
}

bool may_be_better_soon(const RemoteAnswer& answer) {
  return answer.status == 409 || answer.status == 429 || answer.status >= 500;
}

// Sends the request up to kTries times while the server cannot be reached or temporarily refuses
// it, because the server may be restarting. Returns the last result.
template <class Ask>
Expected<RemoteAnswer> with_retries(const Ask& ask) {
  for (int tried = 1;; ++tried) {
    auto answer = ask();
    const bool is_final = answer && !may_be_better_soon(*answer);
    if (is_final || tried == kTries) return answer;
    std::this_thread::sleep_for(std::chrono::seconds(1 << (tried - 1)));
  }
}

}  // namespace

tl::expected<RemoteVitrine, Fault> RemoteVitrine::of(const Arguments& arguments) {
  const std::string origin = origin_of(arguments.text("--server"));
  if (origin.empty()) return arguments.wrong_value("--server", "a URL, as https://museum.example");
  const auto token = access_token(arguments);
  if (!token) return tl::unexpected(token.error());
  if (token->empty()) {
    return misused("the token is missing; name its file by --token-file, or set VITRINE_TOKEN");
  }
  return RemoteVitrine(origin, *token);
}

Expected<RemoteAnswer> RemoteVitrine::send(const std::string& method, const std::string& path,
                                           const Json& body, const std::string& field) {
  const std::string text = body.is_null() ? "" : body.dump();
  RemoteRequest request{.method = method, .url = origin_ + path, .fields = {bearer_}};
  if (!field.empty()) request.fields.push_back(field);
  if (!text.empty()) {
    request.fields.emplace_back("Content-Type: application/json");
    request.body = body_of(text);
  }
  return server_->ask(request);
}

tl::expected<Json, Fault> RemoteVitrine::json_of(const Expected<RemoteAnswer>& answer) const {
  if (!answer) return failed(answer.error());
  if (answer->status >= 400) return failed(words_of(*answer, origin_));
  if (answer->body.empty()) return Json::object();
  Json json = Json::parse(answer->body, nullptr, /*allow_exceptions=*/false);
  if (json.is_object()) return json;
  return failed(
      fmt::format("the response of {} is not JSON; check that it is a Vitrine server", origin_));
}

tl::expected<Json, Fault> RemoteVitrine::ask(const std::string& method, const std::string& path,
                                             const Json& body, const std::string& field) {
  return json_of(send(method, path, body, field));
}

tl::expected<Json, Fault> RemoteVitrine::ask_with_retries(const std::string& method,
                                                          const std::string& path, const Json& body,
                                                          const std::string& field) {
  return json_of(with_retries([&] { return send(method, path, body, field); }));
}

Expected<RemoteAnswer> RemoteVitrine::ask_tus(const std::string& method, const std::string& path,
                                              std::vector<std::string> fields,
                                              std::span<const std::uint8_t> body,
                                              std::function<void(std::uint64_t)> on_sent) {
  fields.insert(fields.end(), {bearer_, "Tus-Resumable: 1.0.0"});
  return server_->ask({.method = method,
                       .url = origin_ + path,
                       .fields = std::move(fields),
                       .body = body,
                       .on_sent = std::move(on_sent)});
}

tl::expected<std::uint64_t, Fault> RemoteVitrine::offset_of(const std::string& path) {
  const auto answer = with_retries([&] { return ask_tus("HEAD", path, {}); });
  if (!answer) return failed(answer.error());
  const std::string text = answer->field("upload-offset");
  std::uint64_t offset = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), offset);
  if (answer->status < 300 && error == std::errc{}) return offset;
  return failed(words_of(*answer, origin_));
}

tl::expected<std::string, Fault> RemoteVitrine::upload(std::span<const std::uint8_t> bytes,
                                                       const ProgressReport& progress) {
  const auto created =
      ask_tus("POST", "/api/v1/uploads", {fmt::format("Upload-Length: {}", bytes.size())});
  if (!created) return failed(created.error());
  if (created->status != 201) return failed(words_of(*created, origin_));
  const std::string path = created->field("location");
  std::uint64_t offset = 0, tries = 0;
  while (offset < bytes.size()) {
    const auto piece =
        bytes.subspan(offset, std::min<std::uint64_t>(kPiece, bytes.size() - offset));
    const auto sent = ask_tus(
        "PATCH", path,
        {"Content-Type: application/offset+octet-stream", fmt::format("Upload-Offset: {}", offset)},
        piece, [&](std::uint64_t n) {
          progress("uploading",
                   static_cast<double>(offset + n) / static_cast<double>(bytes.size()));
        });
    if (sent && sent->status == 204) {
      offset += piece.size();
      tries = 0;
      continue;
    }
    if (sent && !may_be_better_soon(*sent)) return failed(words_of(*sent, origin_));
    const auto now = offset_of(path);
    if (!now) return tl::unexpected(now.error());
    if (*now > offset) tries = 0;
    if (++tries > kTries)
      return failed(sent ? words_of(*sent, origin_) : std::string(sent.error().message));
    offset = *now;
  }
  return path.substr(path.rfind('/') + 1);
}

tl::expected<Json, Fault> RemoteVitrine::await(const std::string& job,
                                               const ProgressReport& progress) {
  for (;;) {
    const auto now = ask_with_retries("GET", "/api/v1/jobs/" + job);
    if (!now) return now;
    const std::string state = now->value("state", "");
    if (state == "done") return now;
    if (state == "failed" || state == "cancelled" || state.empty()) {
      const Json& error = (*now)["error"];
      return failed(error.is_string() ? error.get<std::string>()
                                      : fmt::format("job {} was {}; start it again", job, state));
    }
    const Json& stage = (*now)["stage"];
    progress(stage.is_string() ? stage.get<std::string>() : state, now->value("progress", 0.0));
    std::this_thread::sleep_for(kBetweenLooks);
  }
}

}  // namespace vitrine::server::cli
