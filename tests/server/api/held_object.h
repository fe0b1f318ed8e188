// SPDX-License-Identifier: Apache-2.0
// An object of a store in a folder whose readers wait.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>
#include <string>

#include "codec/core/sha256.h"
#include "support/product_names.h"

namespace vitrine::test {

// Replaces an object by a FIFO, whose readers wait until release() is called.
class HeldObject {
 public:
  HeldObject(const std::filesystem::path& data, const Sha256& object) {
    const std::string name = to_hex(object);
    path_ = data / "objects" / name.substr(0, 2) / name.substr(2, 2) / name;
    kept_ = data / "kept";
    fifo_ = data / "fifo";
    std::filesystem::rename(path_, kept_);
    if (::mkfifo(path_.c_str(), 0600) != 0) throw std::runtime_error("cannot make a FIFO");
  }
  ~HeldObject() { release(); }
  HeldObject(const HeldObject&) = delete;
  HeldObject& operator=(const HeldObject&) = delete;

  // Restores the object, so that the waiting readers can continue.
  void release() {
    if (!std::filesystem::exists(kept_)) return;
    std::filesystem::rename(path_, fifo_);
    std::filesystem::rename(kept_, path_);
    ::close(::open(fifo_.c_str(), O_WRONLY | O_NONBLOCK | O_CLOEXEC));
  }

 private:
  std::filesystem::path path_, kept_, fifo_;
};

}  // namespace vitrine::test
