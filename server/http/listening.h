// SPDX-License-Identifier: Apache-2.0
// Opens listening sockets on an address and port, or on the path of a Unix socket.
#pragma once

#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <cstdint>

#include "codec/core/expected.h"
#include "server/config/settings.h"
#include "server/http/beast.h"

namespace vitrine::server {

using Acceptor = asio::basic_socket_acceptor<asio::generic::stream_protocol>;

// Checks that a socket can listen on `endpoint` now. Fails (kIo) with the cause.
Expected<void> check_address(const Endpoint& endpoint);

// Binds and listens. Returns the port, or 0 for a Unix socket. Only the owner and the group of a
// Unix socket may connect to it. Replaces a Unix socket that a killed daemon has left behind. Fails
// (kIo) with the cause.
Expected<std::uint16_t> listen(Acceptor& acceptor, const Endpoint& endpoint);

}  // namespace vitrine::server
