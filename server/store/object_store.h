// SPDX-License-Identifier: Apache-2.0
// Immutable objects named by the SHA-256 of their bytes. Nothing is ever overwritten: what changes
// is the catalogue's row that names an object.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/sha256.h"
#include "server/catalogue/exclusive_lock.h"

namespace vitrine {

// An object that is open for reading. It stays readable until destroyed, whatever happens to the
// store meanwhile. Safe to use from several threads at once.
class Object {
 public:
  virtual ~Object() = default;

  virtual std::uint64_t size() const = 0;

  // Fills `out` from `offset`. Fails (kIo) unless offset + out.size() <= size().
  virtual Expected<void> read(std::uint64_t offset, std::span<std::uint8_t> out) const = 0;

  // A descriptor for sendfile(2), owned by the object; nothing where the object is in no file. Its
  // file position is shared: give sendfile an explicit offset.
  virtual std::optional<int> descriptor() const { return std::nullopt; }

  Expected<std::vector<std::uint8_t>> read(std::uint64_t offset, std::uint64_t length) const;
};

// Safe to use from several threads and processes at once.
class ObjectStore {
 public:
  virtual ~ObjectStore() = default;

  // Stores `bytes` durably and under `name`, or not at all. False where they were there already,
  // and nothing changes; what is there and damaged is replaced. Fails with kBadInput where the
  // bytes do not have that name, kLimit where the disk is full, kIo where it refuses.
  virtual Expected<bool> put(const Sha256& name, std::span<const std::uint8_t> bytes) = 0;

  // Whoever puts an object and has it named, or takes it away, holds this meanwhile, and checks it
  // before either: nobody else, in this process or another, does so until it is destroyed or lost.
  virtual Expected<std::shared_ptr<const ExclusiveLock>> lock() = 0;

  // Takes the object away; that there is none is no fault. Fails (kIo) where the disk refuses.
  virtual Expected<void> remove(const Sha256& name) = 0;

  // Has the object's grace begin now: it is about to lose its name, and somebody may be on the way
  // to it. That there is none is no fault. Call it with the lock held. Fails (kIo) where the disk
  // refuses.
  virtual Expected<void> begin_grace(const Sha256& name) = 0;

  // Takes away what `keep` does not name and whose grace is over, counted from when it was put or
  // begin_grace() was called, and what interrupted puts have left; the number of objects. Call it
  // with the lock held. Fails (kIo) where the disk refuses, or once the lock is lost; then some are
  // gone and some are not.
  virtual Expected<std::size_t> sweep(const std::set<Sha256>& keep, std::chrono::seconds grace,
                                      const ExclusiveLock& lock) = 0;

  // Null where there is no such object. Of a remote store it is fetched: its bytes are those of its
  // name.
  virtual Expected<std::unique_ptr<Object>> open(const Sha256& name) const = 0;

  // Without opening it; nothing where there is no such object.
  virtual Expected<std::optional<std::uint64_t>> size_of(const Sha256& name) const = 0;
};

}  // namespace vitrine
