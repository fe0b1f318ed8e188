// SPDX-License-Identifier: Apache-2.0
// Sends requests to the remote Vitrine server that --server names, with the token of
// access_token().
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "server/cli/support/arguments.h"
#include "server/remote/remote_server.h"
#include "server/sandbox/sandbox.h"

namespace vitrine::server::cli {

class RemoteVitrine {
 public:
  // Reads --server and the token. Returns a usage error if --server is not a URL, or if the token
  // is missing or malformed.
  static tl::expected<RemoteVitrine, Fault> of(const Arguments& arguments);

  // Returns a text such as "https://host:port".
  const std::string& origin() const { return origin_; }

  // Sends a request and returns the JSON of the response. If the status is 400 or above, returns an
  // error with the server's message. `path` is appended to the origin. A null `body` sends no body.
  // `field` is an additional header field, or empty.
  tl::expected<nlohmann::json, Fault> ask(const std::string& method, const std::string& path,
                                          const nlohmann::json& body = nullptr,
                                          const std::string& field = "");

  // Like ask(), but repeats the request for half a minute while the server is unreachable or
  // temporarily refuses it. Use this only for requests that may be repeated.
  tl::expected<nlohmann::json, Fault> ask_with_retries(const std::string& method,
                                                       const std::string& path,
                                                       const nlohmann::json& body = nullptr,
                                                       const std::string& field = "");

  // Sends the bytes as a resumable upload and returns the upload's ID. Continues the upload after a
  // lost connection.
  tl::expected<std::string, Fault> upload(std::span<const std::uint8_t> bytes,
                                          const ProgressReport& progress);

  // Waits until a job ends, even if the server restarts, and returns the job's final state. Returns
  // an error unless the job succeeds.
  tl::expected<nlohmann::json, Fault> await(const std::string& job, const ProgressReport& progress);

 private:
  RemoteVitrine(std::string origin, const std::string& token)
      : origin_(std::move(origin)),
        bearer_("Authorization: Bearer " + token),
        server_(std::make_unique<RemoteServer>()) {}

  Expected<RemoteAnswer> send(const std::string& method, const std::string& path,
                              const nlohmann::json& body, const std::string& field);
  tl::expected<nlohmann::json, Fault> json_of(const Expected<RemoteAnswer>& answer) const;
  Expected<RemoteAnswer> ask_tus(const std::string& method, const std::string& path,
                                 std::vector<std::string> fields,
                                 std::span<const std::uint8_t> body = {},
                                 std::function<void(std::uint64_t)> on_sent = {});
  tl::expected<std::uint64_t, Fault> offset_of(const std::string& path);

  std::string origin_, bearer_;
  std::unique_ptr<RemoteServer> server_;
};

}  // namespace vitrine::server::cli
