// SPDX-License-Identifier: Apache-2.0
#include "server/auth/authenticator.h"

#include <algorithm>
#include <chrono>
#include <cstring>

#include "server/auth/token.h"

namespace vitrine::server {
namespace {

constexpr std::size_t kMaxLabel = 200;
constexpr std::size_t kMostHeld = 4096;

std::int64_t now() {
  const auto since_epoch = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::milliseconds>(since_epoch).count();
}

bool is_printable(std::string_view text) {
  return std::ranges::none_of(text, [](unsigned char c) { return c < ' ' || c == 0x7f; });
}

// Compares in constant time, so that the duration does not reveal where the two hashes differ.
bool are_equal(const Sha256& a, const Sha256& b) {
  volatile std::uint8_t difference = 0;  // prevents the compiler from leaving the loop early
  for (std::size_t i = 0; i < a.size(); ++i)
    difference = difference | (a[i] ^ b[i]);
  return difference == 0;
}

}  // namespace

Expected<NewToken> create_token(Catalogue& catalogue, Role role, std::string label) {
  if (label.size() > kMaxLabel || !is_printable(label))
    return fail(ErrorCode::kBadInput, "the label is not one line of at most 200 bytes; shorten it");
  NewToken token{TokenId::generate(), generate_token()};
  const auto added = catalogue.add_token({.id = token.id,
                                          .role = role,
                                          .hash = *token_hash(token.text),
                                          .label = std::move(label),
                                          .created = now()});
  if (!added) return tl::unexpected(added.error());
  return token;
}

std::size_t Authenticator::HashOfHash::operator()(const Sha256& hash) const noexcept {
  std::size_t word;
  std::memcpy(&word, hash.data(), sizeof word);
  return word;
}

Expected<std::optional<Caller>> Authenticator::find(std::string_view text, Clock::time_point now) {
  const auto hash = token_hash(text);
  if (!hash) return std::nullopt;
  return ask(*hash, now);
}

std::optional<Caller> Authenticator::cached(std::string_view text, Clock::time_point now) {
  const auto hash = token_hash(text);
  return hash ? cached(*hash, now) : std::nullopt;
}

Expected<bool> Authenticator::is_in_force(const Caller& caller, Clock::time_point now) {
  if (cached(caller.hash, now)) return true;
  const auto found = ask(caller.hash, now);
  if (!found) return tl::unexpected(found.error());
  return found->has_value();
}

void Authenticator::forget() {
  const std::scoped_lock lock(mutex_);
  ++forgotten_;
  held_.clear();
}

Expected<std::optional<Caller>> Authenticator::ask(const Sha256& hash, Clock::time_point now) {
  std::uint64_t forgotten = 0;
  {
    const std::scoped_lock lock(mutex_);
    forgotten = forgotten_;
  }
  const auto tokens = catalogue_.tokens_like(hash);
  if (!tokens) return tl::unexpected(tokens.error());
  for (const TokenRecord& token : *tokens) {
    if (!are_equal(token.hash, hash)) continue;
    const Caller caller{token.id, token.role, token.hash};
    remember(caller, now, forgotten);
    return caller;
  }
  return std::nullopt;
}

std::optional<Caller> Authenticator::cached(const Sha256& hash, Clock::time_point now) {
  const std::scoped_lock lock(mutex_);
  const auto found = held_.find(hash);
  if (found == held_.end() || now - found->second.asked >= kMemory) return std::nullopt;
  Memory& memory = found->second;
  const bool is_due = now - memory.asked >= kMemory / 2 && !memory.is_being_asked;
  if (is_due) memory.is_being_asked = true;
  return is_due ? std::nullopt : std::optional(memory.caller);
}

void Authenticator::remember(const Caller& caller, Clock::time_point now, std::uint64_t forgotten) {
  const std::scoped_lock lock(mutex_);
  if (forgotten != forgotten_) return;
  if (held_.size() >= kMostHeld) held_.clear();
  held_[caller.hash] = {caller, now};
}

}  // namespace vitrine::server
