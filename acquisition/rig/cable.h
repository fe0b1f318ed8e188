// SPDX-License-Identifier: Apache-2.0
// A cable that somebody else pulls and, after a while, puts back.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace vitrine::rig {

inline constexpr std::chrono::milliseconds kUnplugged{1200};

class Cable {
 public:
  // Both are called by a thread of the cable's own, one after the other. A cable that is destroyed
  // is not put back any more.
  Cable(std::function<void()> pull, std::function<void()> put_back);

  // At once, and put back kUnplugged later; returns before. Again: the while begins anew.
  void pull();

 private:
  std::function<void()> pull_, put_back_;
  std::jthread hand_;
};

}  // namespace vitrine::rig
