// SPDX-License-Identifier: Apache-2.0
// The interface of a protocol that takes over a connection from HTTP with status 101 ([RFC9110]
// section 7.8).
#pragma once

#include <boost/beast/http/string_body.hpp>
#include <memory>

#include "server/http/connection.h"

namespace vitrine::server {

class HttpServer;

struct UpgradedConnection {
  std::shared_ptr<Connection> connection;
  beast::http::request<beast::http::string_body> request;  // the request for the upgrade
};

// A handler returns an object of this class as Response::upgrade.
class Upgrade {
 public:
  virtual ~Upgrade() = default;

  // Answers the upgrade request and serves the connection. Runs on the connection's strand. Returns
  // once no operation on the connection is pending.
  virtual asio::awaitable<void> serve(UpgradedConnection upgraded, HttpServer& server) = 0;

  // Whether the client may still see the data that serve() sends. If not, the server asks the
  // connection to end. Called about twice a second while serve() runs on another thread. May wait
  // for the catalogue, but must not open a model's file: all connections are checked on one thread.
  virtual bool may_continue() { return true; }
};

}  // namespace vitrine::server
