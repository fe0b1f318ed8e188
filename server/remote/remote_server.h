// SPDX-License-Identifier: Apache-2.0
// Requests to another server over HTTP or HTTPS, one after the other on one connection.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"

namespace vitrine {

// By whom a request is, as S3 wants it (AWS signature, version 4). One of the request's fields is
// x-amz-content-sha256, and its query is encoded and sorted by name.
struct RemoteSigner {
  std::string region, access_key, secret_key;
};

struct RemoteRequest {
  std::string method = "GET";
  std::string url;
  std::vector<std::string> fields = {};             // "Name: value"
  std::span<const std::uint8_t> body = {};          // must live until the answer
  std::function<void(std::uint64_t)> on_sent = {};  // bytes of the body so far
  std::chrono::seconds patience{30};                // for a connection, and for each byte to follow
  std::optional<std::chrono::seconds> to_connect = {};  // the former, where it is another
  std::chrono::seconds deadline{0};                     // for all of it; 0: none
  std::function<bool()> given_up = {};                  // asked about once a second: true ends it
  const RemoteSigner* signer = nullptr;                 // null: the request is not signed
  bool direct = false;  // by no proxy, whatever the environment says
  // Gets the body of an answer 2xx, which RemoteAnswer does not hold then; false ends it.
  std::function<bool(std::span<const std::uint8_t>)> take = {};
};

struct RemoteAnswer {
  long status = 0;
  std::map<std::string, std::string> fields;  // names in lower case
  std::string body;                           // its first kMost bytes
  std::optional<double> certificate_days;     // until the server's expires; nothing without TLS

  static constexpr std::size_t kMost = 4 << 20;
  std::string field(const std::string& name) const {
    const auto found = fields.find(name);
    return found == fields.end() ? "" : found->second;
  }
};

// Where the variable SSL_CERT_FILE names certificates of authorities (PEM), it trusts those in
// place of the system's.
class RemoteServer {
 public:
  RemoteServer();
  ~RemoteServer();
  RemoteServer(const RemoteServer&) = delete;
  RemoteServer& operator=(const RemoteServer&) = delete;

  // Any answer is one; redirections are not followed. kIo where there is none.
  Expected<RemoteAnswer> ask(const RemoteRequest& request);

  // The head of the answer to a request without a body whose connection is to become something
  // else; a connection of its own.
  Expected<std::string> upgrade(const RemoteRequest& request);

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

// "http://host:port" or "https://…" of a URL, without a path; empty where it is none.
std::string origin_of(std::string_view url);

}  // namespace vitrine
