// SPDX-License-Identifier: Apache-2.0
// Tokens: who may call, and as what.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "codec/core/expected.h"
#include "server/auth/throttle.h"
#include "server/catalogue/catalogue.h"

namespace vitrine {

struct Caller {
  ModelId token;  // its id, which is no secret
  Role role = Role::kNone;
};

struct NewToken {
  ModelId id;
  std::string text;  // shown once, stored nowhere
};

// kBadInput where the label is not one short line, kIo where the catalogue refuses.
Expected<NewToken> create_token(Catalogue& catalogue, Role role, std::string label);

// Thread-safe.
class Authenticator {
 public:
  explicit Authenticator(Catalogue& catalogue) : catalogue_(catalogue) {}

  // Whose token `text` is; nothing where it is nobody's. kIo where the catalogue refuses.
  Expected<std::optional<Caller>> find(std::string_view text) const;

  // Whether the token has not been revoked since. kIo where the catalogue refuses.
  Expected<bool> is_in_force(const Caller& caller) const;

  // To be told of each token that was nobody's. A token in force is never throttled: behind a proxy
  // operators and strangers may share an address, and an emergency stop must get through.
  Throttle& throttle() { return throttle_; }

 private:
  Catalogue& catalogue_;
  Throttle throttle_;
};

}  // namespace vitrine
