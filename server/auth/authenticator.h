// SPDX-License-Identifier: Apache-2.0
// Tokens: who may call, and as what.
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

namespace vitrine {

struct Caller {
  ModelId token;  // its id, which is no secret
  Role role = Role::kNone;
  Sha256 hash{};  // of its text
};

struct NewToken {
  ModelId id;
  std::string text;  // shown once, stored nowhere
};

// kBadInput where the label is not one short line, kIo where the catalogue refuses.
Expected<NewToken> create_token(Catalogue& catalogue, Role role, std::string label);

// Whose tokens were in force is remembered for kMemory: as long may one that another process
// revokes still open doors. Thread-safe.
class Authenticator {
 public:
  using Clock = std::chrono::steady_clock;
  static constexpr std::chrono::milliseconds kMemory{100};

  explicit Authenticator(Catalogue& catalogue) : catalogue_(catalogue) {}

  // Whose token `text` is; nothing where it is nobody's. Asks the catalogue; kIo where that
  // refuses.
  Expected<std::optional<Caller>> find(std::string_view text, Clock::time_point now = Clock::now());

  // The same from memory. Nothing where it has to be asked; when half of kMemory is over one is
  // told so, and the others need not wait.
  std::optional<Caller> held(std::string_view text, Clock::time_point now = Clock::now());

  // Whether the token has not been revoked since. kIo where the catalogue refuses.
  Expected<bool> is_in_force(const Caller& caller, Clock::time_point now = Clock::now());

  // What this process has revoked is so from the next call on.
  void forget();

  // To be told of each token that was nobody's. A token in force is never throttled: behind a proxy
  // operators and strangers may share an address, and an emergency stop must get through.
  Throttle& throttle() { return throttle_; }

 private:
  struct Memory {
    Caller caller;
    Clock::time_point asked;      // when the catalogue was
    bool is_being_asked = false;  // again
  };
  struct HashOfHash {
    std::size_t operator()(const Sha256& hash) const noexcept;
  };

  Expected<std::optional<Caller>> ask(const Sha256& hash, Clock::time_point now);
  std::optional<Caller> held(const Sha256& hash, Clock::time_point now);
  void remember(const Caller& caller, Clock::time_point now, std::uint64_t forgotten);

  Catalogue& catalogue_;
  Throttle throttle_;
  std::mutex mutex_;             // guards what follows
  std::uint64_t forgotten_ = 0;  // how often: what was asked before is no news
  std::unordered_map<Sha256, Memory, HashOfHash> held_;
};

}  // namespace vitrine
