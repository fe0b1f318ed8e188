// SPDX-License-Identifier: Apache-2.0
// Where the events of a text/event-stream answer come from.
#pragma once

#include <optional>
#include <string>

namespace vitrine {

struct Event {
  std::string name, data;  // one line each
};

// Asked by one connection, never from two threads at once, at most five times a second, and only
// once the peer has taken what came before: a slow peer misses states in between and costs no
// memory. Calls must not wait, nor throw anything but bad_alloc.
class EventSource {
 public:
  virtual ~EventSource() = default;

  // What has changed since the last call; nothing where nothing has.
  virtual std::optional<Event> next() = 0;
  // Whether nothing will follow what next() has given.
  virtual bool ended() const = 0;
};

}  // namespace vitrine
