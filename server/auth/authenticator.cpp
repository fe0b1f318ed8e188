// SPDX-License-Identifier: Apache-2.0
#include "server/auth/authenticator.h"

#include <algorithm>
#include <chrono>

#include "server/auth/token.h"

namespace vitrine {
namespace {

constexpr std::size_t kMaxLabel = 200;

std::int64_t now() {
  const auto since_epoch = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::milliseconds>(since_epoch).count();
}

bool is_printable(std::string_view text) {
  return std::ranges::none_of(text, [](unsigned char c) { return c < ' ' || c == 0x7f; });
}

// Takes as long wherever the two differ.
bool are_equal(const Sha256& a, const Sha256& b) {
  volatile std::uint8_t difference = 0;  // keeps the compiler from leaving the loop early
  for (std::size_t i = 0; i < a.size(); ++i)
    difference = difference | (a[i] ^ b[i]);
  return difference == 0;
}

}  // namespace

Expected<NewToken> create_token(Catalogue& catalogue, Role role, std::string label) {
  if (label.size() > kMaxLabel || !is_printable(label))
    return fail(ErrorCode::kBadInput, "the label is not one line of at most 200 bytes; shorten it");
  NewToken token{ModelId::generate(), generate_token()};
  const auto added = catalogue.add_token({.id = token.id,
                                          .role = role,
                                          .hash = *token_hash(token.text),
                                          .label = std::move(label),
                                          .created = now()});
  if (!added) return Unexpected(added.error());
  return token;
}

Expected<std::optional<Caller>> Authenticator::find(std::string_view text) const {
  const auto hash = token_hash(text);
  if (!hash) return std::nullopt;
  const auto tokens = catalogue_.tokens_like(*hash);
  if (!tokens) return Unexpected(tokens.error());
  for (const TokenRecord& token : *tokens) {
    if (are_equal(token.hash, *hash)) return Caller{token.id, token.role};
  }
  return std::nullopt;
}

Expected<bool> Authenticator::is_in_force(const Caller& caller) const {
  const auto tokens = catalogue_.tokens();
  if (!tokens) return Unexpected(tokens.error());
  return std::ranges::find(*tokens, caller.token, &TokenRecord::id) != tokens->end();
}

}  // namespace vitrine
