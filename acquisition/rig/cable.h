// SPDX-License-Identifier: Apache-2.0
// A cable that somebody else pulls and, after a while, puts back.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace vitrine::rig {

// Longer than a client repeats what is not acknowledged (Aravis: for 3 s). A camera that starts
// within that time would take the repeated trigger for a new one: the simulated camera obeys it
// though nobody controls it yet, keeps it until it streams, and every frame then is the one before.
inline constexpr std::chrono::milliseconds kUnplugged{5000};

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
