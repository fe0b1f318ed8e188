// SPDX-License-Identifier: Apache-2.0
// Signed requests to one bucket, tried again where the store is busy or away for a moment.
#pragma once

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

namespace vitrine {

struct S3Keys {
  std::string access, secret;
};

struct S3Request {
  std::string method = "GET";
  std::string key = {};    // empty: the bucket
  std::string query = {};  // encoded, and sorted by name
  std::span<const std::uint8_t> body = {};
  Sha256 body_sha256 = sha256({});  // the store refuses another body
  // Gets the body of an answer 2xx; `restart` is called before each attempt.
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

  // The last answer, once the attempts are used up; kIo where there is none.
  Expected<RemoteAnswer> ask(const S3Request& request);

  // kIo: what is refused, why, and what to do.
  Unexpected refused(std::string_view what, const RemoteAnswer& answer) const;

 private:
  Expected<RemoteAnswer> ask_once(const S3Request& request);
  std::unique_ptr<RemoteServer> take_connection();

  const S3Address address_;
  const RemoteSigner signer_;
  const Backoff backoff_;
  std::mutex mutex_;                                 // guards what follows
  std::vector<std::unique_ptr<RemoteServer>> idle_;  // no more than were in use at once
};

}  // namespace vitrine
