// SPDX-License-Identifier: Apache-2.0
// The object store. It contains immutable objects, each named by the SHA-256 of its bytes. An
// object is never overwritten. To change a model's file, the catalogue refers to a new object.
#pragma once

#include <chrono>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <vector>

#include "codec/core/expected.h"
#include "codec/core/sha256.h"
#include "server/catalogue/exclusive_lock.h"
#include "server/content/object.h"

namespace vitrine::server {

enum class ObjectState { kIntact, kDamaged, kMissing };

// Called after each piece of an object was read, with the length of the piece in bytes. May wait,
// to limit the rate. Returns false to stop reading.
using OnPiece = std::function<bool(std::uint64_t bytes)>;

// Safe to use from several threads and processes at once.
class ObjectStore {
 public:
  virtual ~ObjectStore() = default;

  // Stores `bytes` durably as the object `name`, completely or not at all. Returns true if the
  // object was written, false if it existed undamaged. Replaces a damaged object. Fails with
  // kBadInput if `name` is not the SHA-256 of the bytes, with kLimit if the disk is full, and with
  // kIo if the store fails for another reason.
  virtual Expected<bool> put(const Sha256& name, std::span<const std::uint8_t> bytes) = 0;

  // Acquires the store's lock, which only one process holds at a time. A caller must hold the lock
  // while it stores an object and adds a reference to the catalogue, or while it removes an object.
  // The lock may be lost, so the caller must check it before each step.
  virtual Expected<std::shared_ptr<const ExclusiveLock>> lock() = 0;

  // Removes the object, if it exists. Fails with kIo.
  virtual Expected<void> remove(const Sha256& name) = 0;

  // If the object exists, starts its grace period again. The caller must do this before it removes
  // a reference to the object, because a client may be about to read the object. The caller must
  // hold the store's lock. Fails with kIo.
  virtual Expected<void> begin_grace(const Sha256& name) = 0;

  // Removes remains of interrupted put() calls, and unreferenced objects whose grace period has
  // ended. `keep` lists the referenced objects. The grace period of an object lasts `grace` from
  // the last put() or begin_grace(). Returns the number of objects removed. `lock` is the store's
  // lock. Fails with kIo if the store fails; some objects may have been removed before.
  virtual Expected<std::size_t> sweep(const std::set<Sha256>& keep, std::chrono::seconds grace,
                                      const ExclusiveLock& lock) = 0;

  // Opens an object. Returns null if it does not exist. If this process has not checked the
  // object's SHA-256 before, reads the whole object to check it. Fails with kState if the object is
  // damaged, and with kIo if the store fails.
  virtual Expected<std::unique_ptr<Object>> open(const Sha256& name) const = 0;

  // Reads the whole object from the disk or the bucket and checks its SHA-256, even if it was
  // checked before. Fails with kIo if the store fails or `on_piece` returned false.
  virtual Expected<ObjectState> check(const Sha256& name, const OnPiece& on_piece) const = 0;

  // Whether open objects are local copies, which check() does not read.
  virtual bool keeps_copies() const { return false; }

  // Returns the size of an object without opening it, or nullopt if the object does not exist.
  // Returns 0 if its file is damaged so that it has no size. Fails with kIo if the store fails.
  virtual Expected<std::optional<std::uint64_t>> size_of(const Sha256& name) const = 0;
};

}  // namespace vitrine::server
