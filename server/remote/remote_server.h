// SPDX-License-Identifier: Apache-2.0
// Sends requests to another server over HTTP or HTTPS, one after the other on one connection.
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

namespace vitrine::server {

// Credentials for signing a request to S3 (AWS signature, version 4; [SigV4]). A signed request
// must have the field x-amz-content-sha256. Its query must be encoded and sorted by name.
struct RemoteSigner {
  std::string region, access_key, secret_key;
};

struct RemoteRequest {
  std::string method = "GET";
  std::string url;
  std::vector<std::string> fields = {};             // header fields, each in the form "Name: value"
  std::span<const std::uint8_t> body = {};          // must outlive the request
  std::function<void(std::uint64_t)> on_sent = {};  // receives the number of body bytes sent
  std::chrono::seconds timeout{30};  // limit for connecting, and for a stalled transfer
  // time limit for connecting; nullopt: `timeout`
  std::optional<std::chrono::seconds> to_connect = {};
  std::chrono::seconds deadline{0};      // limit for the whole request; 0: none
  std::function<bool()> given_up = {};   // called each second; returns true to cancel
  const RemoteSigner* signer = nullptr;  // null: the request is not signed
  bool bypasses_proxy = false;           // whether to ignore the environment's proxy
  // Receives the body of a 2xx response in parts; RemoteAnswer::body is then empty. Returns false
  // to cancel.
  std::function<bool(std::span<const std::uint8_t>)> take = {};
};

struct RemoteAnswer {
  long status = 0;
  std::map<std::string, std::string> fields;  // names in lower case
  std::string body;                           // at most the first kMost bytes
  // Days until the server's certificate expires; nullopt if TLS is not used.
  std::optional<double> certificate_days;

  static constexpr std::size_t kMost = 4 << 20;
  std::string field(const std::string& name) const {
    const auto found = fields.find(name);
    return found == fields.end() ? "" : found->second;
  }
};

// A client of one server. If the environment variable SSL_CERT_FILE names a PEM file of certificate
// authorities, the client trusts these authorities instead of the system's.
class RemoteServer {
 public:
  RemoteServer();
  ~RemoteServer();
  RemoteServer(const RemoteServer&) = delete;
  RemoteServer& operator=(const RemoteServer&) = delete;

  // Sends a request and returns the answer. Any HTTP status counts as an answer; redirections are
  // not followed. Fails with kIo if there is no answer.
  Expected<RemoteAnswer> ask(const RemoteRequest& request);

  // Sends an upgrade request without a body on a new connection. Returns the head of the answer.
  Expected<std::string> upgrade(const RemoteRequest& request);

 private:
  struct Handle;
  std::unique_ptr<Handle> handle_;
};

// Returns the origin of a URL, "http://host:port" or "https://host:port"; empty if the text is not
// an HTTP URL.
std::string origin_of(std::string_view url);

}  // namespace vitrine::server
