// SPDX-License-Identifier: Apache-2.0
// Simulates a cable that is unplugged and, after a while, plugged in again.
#pragma once

#include <chrono>
#include <functional>
#include <thread>

namespace vitrine::acquisition::rig {

// Time that the cable stays unplugged. It is longer than the time during which a client repeats an
// unanswered request (Aravis: 3 s). With a shorter time, the camera would come back and receive a
// repeated trigger before a client controls it. The camera would keep that trigger until streaming
// starts, and deliver each later frame one trigger late.
inline constexpr std::chrono::milliseconds kUnplugged{5000};

class Cable {
 public:
  // The cable's own thread calls `pull` and `put_back` alternately. Destroying the cable cancels a
  // pending reconnection.
  Cable(std::function<void()> pull, std::function<void()> put_back);

  // Unplugs at once and returns. The cable is plugged in again after kUnplugged; a further call
  // restarts that interval.
  void pull();

 private:
  std::function<void()> pull_, put_back_;
  std::jthread hand_;
};

}  // namespace vitrine::acquisition::rig
