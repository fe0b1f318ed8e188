// SPDX-License-Identifier: Apache-2.0
// One connection: requests in, responses out, until one side ends it.
#pragma once

#include <memory>

#include "server/http/http_server.h"

namespace vitrine {

asio::awaitable<void> run_session(std::shared_ptr<Connection> connection, HttpServer& server);

}  // namespace vitrine
