// SPDX-License-Identifier: Apache-2.0
// Sends signed requests to one bucket, and retries while the store is busy or unreachable. Uploads
// objects, in parts if they are long.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/sha256.h"
#include "server/remote/remote_server.h"
#include "server/store/backoff.h"
#include "server/store/s3_address.h"

namespace vitrine::server {

struct S3Keys {
  std::string access, secret;
};

struct S3Request {
  std::string method = "GET";
  std::string key = {};    // key of the object; empty: the bucket itself
  std::string query = {};  // encoded parameters, sorted by name
  std::span<const std::uint8_t> body = {};
  Sha256 body_sha256 = sha256({});  // SHA-256 of the body; the store checks it
  // `take` receives the body of a 2xx response in parts. `restart` is called before each attempt,
  // so that the caller can drop the parts received in a failed attempt. `take` returns false to
  // cancel the request, which is then not retried.
  std::function<bool(std::span<const std::uint8_t>)> take = {};
  std::function<void()> restart = {};
};

// Safe to use from several threads at once.
class S3Client {
 public:
  S3Client(S3Address address, S3Keys keys, Backoff backoff = {})
      : address_(std::move(address)),
        signer_{address_.region, std::move(keys.access), std::move(keys.secret)},
        backoff_(std::move(backoff)) {}

  const S3Address& address() const { return address_; }

  // Sends a request, with retries, and returns the last response. Fails with kIo if the last
  // attempt got no response. For a short time after that, failed requests are not retried, because
  // visitors must not wait for an unreachable store.
  Expected<RemoteAnswer> ask(const S3Request& request);

  // Returns a kIo error that states the refused action, the cause and the next step.
  Unexpected refused(std::string_view what, const RemoteAnswer& answer) const;

 private:
  using Clock = std::chrono::steady_clock;

  Expected<RemoteAnswer> ask_once(const S3Request& request);
  std::unique_ptr<RemoteServer> take_connection();

  const S3Address address_;
  const RemoteSigner signer_;
  const Backoff backoff_;
  std::atomic<Clock::time_point> unreachable_until_{Clock::time_point::min()};
  std::mutex mutex_;                                 // guards the members below
  std::vector<std::unique_ptr<RemoteServer>> idle_;  // open connections that are not in use
};

// Stores an object completely or not at all. Uses a multipart upload if it is longer than
// `part_bytes`. Fails with kIo.
Expected<void> s3_upload(S3Client& client, const std::string& key,
                         std::span<const std::uint8_t> bytes, std::uint64_t part_bytes);

// Aborts a multipart upload. Succeeds if the upload does not exist. Fails with kIo.
Expected<void> s3_give_up(S3Client& client, const std::string& key, const std::string& upload);

}  // namespace vitrine::server
