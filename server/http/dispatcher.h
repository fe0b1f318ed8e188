// SPDX-License-Identifier: Apache-2.0
// Makes the response to a request: finds the route, applies the rate limit, authorises the caller,
// and runs the handler on its executor.
#pragma once

#include <functional>

#include "server/http/request_reader.h"

namespace vitrine::server {

// Use this only on the connection's strand.
class Dispatcher {
 public:
  Dispatcher(Connection& connection, HttpServer& server, RequestReader& reader)
      : connection_(connection), server_(server), reader_(reader) {}

  // Counts the request towards the client's request rate if the response is an error or comes from
  // no route. Such responses are logged, so their rate must be limited. A request that has already
  // been counted is not counted again, and an emergency stop with a valid token is never counted.
  // If the client exceeds the rate, the response becomes 429.
  void count_error(Exchange& exchange);

  // Sets exchange.response. Returns false if there is no response to send, because the peer has
  // disconnected or the server drains.
  asio::awaitable<bool> dispatch(RequestParser& parser, Exchange& exchange);

 private:
  void find_route(const RequestParser::value_type& request, Exchange& exchange) const;
  asio::awaitable<bool> answer(RequestParser& parser, Exchange& exchange);
  bool is_beyond_rate(std::string_view client, Exchange& exchange);
  bool has_no_call_left(std::string_view client, Exchange& exchange);
  asio::awaitable<bool> authorise_caller(const RequestHeader& header, Exchange& exchange);
  asio::awaitable<void> handle(const Request& request, Exchange& exchange);
  asio::awaitable<bool> open_first(const Request& request, const Exchange& exchange,
                                   const std::function<void()>& run);
  template <class Make>
  auto guarded(std::string_view id, const Make& make) -> decltype(make());
  asio::awaitable<bool> pour(RequestParser& parser, Exchange& exchange);
  template <class Task>
  asio::awaitable<void> on_worker(Executor executor, const Exchange& exchange, const Task& task,
                                  std::string target = "");

  Connection& connection_;
  HttpServer& server_;
  RequestReader& reader_;
};

}  // namespace vitrine::server
