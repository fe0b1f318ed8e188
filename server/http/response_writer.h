// SPDX-License-Identifier: Apache-2.0
// Writes responses to a connection. Records each response in the access log, the audit log and the
// metrics.
#pragma once

#include "server/http/exchange.h"
#include "server/http/http_server.h"

namespace vitrine::server {

// Status logged for a request whose peer disconnected before the response was sent.
inline constexpr unsigned kUnanswered = 499;

// Use this only on the connection's strand.
class ResponseWriter {
 public:
  ResponseWriter(Connection& connection, HttpServer& server)
      : connection_(connection), server_(server) {}

  // Writes the response. Returns false if it could not be sent completely.
  asio::awaitable<bool> write(const RequestHeader& request, Exchange& exchange);

  void record(const Exchange& exchange, const RequestHeader& request, unsigned status,
              std::uint64_t bytes) const;

  // Whether the server has sent its last response on this connection. The peer may still be
  // sending.
  bool is_at_end() const { return is_at_end_; }

 private:
  void audit(const Exchange& exchange, const RequestHeader& request, std::string_view route,
             unsigned status) const;
  std::string logged_address(const Client& client) const;

  Connection& connection_;
  HttpServer& server_;
  bool is_at_end_ = false;
};

}  // namespace vitrine::server
