// SPDX-License-Identifier: Apache-2.0
// A base class for test stores that replace single functions of another object store.
#pragma once

#include "server/store/object_store.h"
#include "support/product_names.h"

namespace vitrine::test {

// A store that forwards all calls to another store. Tests derive from this class to replace single
// functions.
class StoreBefore : public ObjectStore {
 public:
  explicit StoreBefore(ObjectStore& before) : before_(before) {}

  Expected<bool> put(const Sha256& name, std::span<const std::uint8_t> bytes) override {
    return before_.put(name, bytes);
  }
  Expected<std::shared_ptr<const ExclusiveLock>> lock() override { return before_.lock(); }
  Expected<void> remove(const Sha256& name) override { return before_.remove(name); }
  Expected<void> begin_grace(const Sha256& name) override { return before_.begin_grace(name); }
  Expected<std::size_t> sweep(const std::set<Sha256>& keep, std::chrono::seconds grace,
                              const ExclusiveLock& lock) override {
    return before_.sweep(keep, grace, lock);
  }
  Expected<std::unique_ptr<Object>> open(const Sha256& name) const override {
    return before_.open(name);
  }
  Expected<ObjectState> check(const Sha256& name, const OnPiece& on_piece) const override {
    return before_.check(name, on_piece);
  }
  bool keeps_copies() const override { return before_.keeps_copies(); }
  Expected<std::optional<std::uint64_t>> size_of(const Sha256& name) const override {
    return before_.size_of(name);
  }

 protected:
  ObjectStore& before_;
};

}  // namespace vitrine::test
