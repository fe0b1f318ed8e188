// SPDX-License-Identifier: Apache-2.0
// A Vitrine server elsewhere, as --server and --token name it.
#pragma once

#include <nlohmann/json.hpp>
#include <string>

#include "server/cli/arguments.h"
#include "server/jobs/sandbox.h"
#include "server/remote/remote_server.h"

namespace vitrine::cli {

class RemoteVitrine {
 public:
  // A fault of usage where --server is no URL or --token is missing.
  static tl::expected<RemoteVitrine, Fault> of(const Arguments& arguments);

  const std::string& origin() const { return origin_; }  // "https://host:port"

  // Any JSON answer below 400 but what it says itself otherwise; the server's own words where it
  // refuses. `path` begins behind the origin; a null body is none.
  tl::expected<nlohmann::json, Fault> ask(const std::string& method, const std::string& path,
                                          const nlohmann::json& body = nullptr,
                                          const std::string& field = "");

  // The same, again and again for half a minute where the server cannot be reached or says that it
  // may be better soon: for what may be asked twice.
  tl::expected<nlohmann::json, Fault> ask_patiently(const std::string& method,
                                                    const std::string& path,
                                                    const nlohmann::json& body = nullptr,
                                                    const std::string& field = "");

  // Sends the bytes as a resumable upload, and goes on where the line breaks; its id.
  tl::expected<std::string, Fault> upload(std::span<const std::uint8_t> bytes,
                                          const ProgressReport& progress);

  // Waits for the end of a job, over restarts of the server, too; what it is then. A fault where it
  // is not done.
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

}  // namespace vitrine::cli
