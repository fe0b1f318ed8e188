// SPDX-License-Identifier: Apache-2.0
// The source of the events of a text/event-stream response [SSE].
#pragma once

#include <optional>
#include <string>

namespace vitrine::server {

struct Event {
  std::string name, data;  // one line each
  // One line. The client sends it back as Last-Event-ID when it reconnects.
  std::string id;
};

// A source belongs to one connection, which calls next() and ended() at most five times a second
// and never from two threads at once. The connection calls next() only after the previous event has
// been sent. A slow client therefore misses intermediate states, but events do not accumulate in
// memory. next() and ended() must not block, and may throw only std::bad_alloc.
class EventSource {
 public:
  virtual ~EventSource() = default;

  // Returns an event that describes the change since the last call, or nullopt if there is no
  // change.
  virtual std::optional<Event> next() = 0;
  // Whether next() has returned the last event.
  virtual bool ended() const = 0;
  // Whether the client may still see the events. If not, the server ends the connection. Called
  // about twice a second while the connection calls the other functions. May wait for the
  // catalogue, but must not open a model's file: all connections are checked on one thread.
  virtual bool may_continue() { return true; }
};

}  // namespace vitrine::server
