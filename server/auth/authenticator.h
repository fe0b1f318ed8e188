// SPDX-License-Identifier: Apache-2.0
// Authenticates the callers of the API by their tokens and returns their roles.
#pragma once

#include <chrono>
#include <mutex>
#include <optional>
#include <string>
#include <string_view>
#include <unordered_map>

#include "codec/core/expected.h"
#include "server/auth/throttle.h"
#include "server/catalogue/catalogue.h"

namespace vitrine::server {

struct Caller {
  TokenId token;  // the token's ID; only the token's text is secret
  Role role = Role::kNone;
  Sha256 hash{};  // SHA-256 of the token's text
};

struct NewToken {
  TokenId id;
  std::string text;  // shown once to its creator and never stored
};

// Creates a token and adds it to the catalogue. Fails with kBadInput if the label is not one short
// line, and with kIo if the catalogue fails.
Expected<NewToken> create_token(Catalogue& catalogue, Role role, std::string label);

// Authenticates callers. Caches each valid token for kMemory, so that a token that another process
// revokes may still be accepted for up to kMemory. Thread-safe.
class Authenticator {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kMemory{100};

  explicit Authenticator(Catalogue& catalogue) : catalogue_(catalogue) {}

  // Looks up the token `text` in the catalogue. Returns its caller, or nullopt if the token does
  // not exist or was revoked. Fails with kIo if the catalogue fails.
  Expected<std::optional<Caller>> find(std::string_view text, Clock::time_point now = Clock::now());

  // Looks up the token `text` in the cache. Returns nullopt if the caller must use find(). When an
  // entry is older than half of kMemory, one call returns nullopt, so that its caller refreshes the
  // entry. Other calls still get the entry in the meantime.
  std::optional<Caller> cached(std::string_view text, Clock::time_point now = Clock::now());

  // Whether the token has not been revoked. Fails with kIo if the catalogue fails.
  Expected<bool> is_in_force(const Caller& caller, Clock::time_point now = Clock::now());

  // Clears the cache, so that the next call refuses a token that this process has just revoked.
  void forget();

  // Limits failed authentications. Callers with a valid token are never limited: behind a proxy,
  // operators and strangers may share an address, and an emergency stop must always work.
  Throttle& throttle() { return throttle_; }

 private:
  struct Memory {
    Caller caller;
    Clock::time_point asked;      // time of the last lookup in the catalogue
    bool is_being_asked = false;  // whether a caller is repeating the lookup
  };
  struct HashOfHash {
    std::size_t operator()(const Sha256& hash) const noexcept;
  };

  Expected<std::optional<Caller>> ask(const Sha256& hash, Clock::time_point now);
  std::optional<Caller> cached(const Sha256& hash, Clock::time_point now);
  void remember(const Caller& caller, Clock::time_point now, std::uint64_t forgotten);

  Catalogue& catalogue_;
  Throttle throttle_;
  std::mutex mutex_;  // guards the members below
  // Number of forget() calls. The result of a lookup is stale if forget() was called meanwhile.
  std::uint64_t forgotten_ = 0;
  std::unordered_map<Sha256, Memory, HashOfHash> held_;
};

}  // namespace vitrine::server
