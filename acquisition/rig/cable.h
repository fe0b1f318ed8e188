// SPDX-License-Identifier: Apache-2.0
// A cable that somebody pulls and, after a while, puts back.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace vitrine::rig {

inline constexpr std::chrono::milliseconds kUnplugged{1200};

class Cable {
 public:
  // Neither is called while the other runs. A cable that is destroyed is not put back any more.
  Cable(std::function<void()> pull, std::function<void()> put_back);

  // Returns when it is pulled; kUnplugged later it is put back.
  void pull();

 private:
  std::function<void()> pull_, put_back_;
  std::jthread hand_;
};

}  // namespace vitrine::rig
