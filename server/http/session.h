// SPDX-License-Identifier: Apache-2.0
// Serves one connection: reads requests and writes responses until one side ends it.
#pragma once

#include <memory>

#include "server/http/http_server.h"

namespace vitrine::server {

asio::awaitable<void> run_session(std::shared_ptr<Connection> connection, HttpServer& server);

}  // namespace vitrine::server
