// SPDX-License-Identifier: Apache-2.0
// Sockets that listen: on an address and a port, or on a path.
#pragma once

#include <boost/asio/basic_socket_acceptor.hpp>
#include <boost/asio/generic/stream_protocol.hpp>
#include <cstdint>

#include "codec/core/expected.h"
#include "server/config/settings.h"
#include "server/http/beast.h"

namespace vitrine {

using Acceptor = asio::basic_socket_acceptor<asio::generic::stream_protocol>;

// Whether one could listen there now. Fails (kIo) with the cause.
Expected<void> check_address(const Endpoint& endpoint);

// Binds and listens. Returns the port, 0 for a Unix socket: that its owner and its group may
// connect to; what a daemon that was killed has left at its path is replaced. Fails (kIo) with the
// cause.
Expected<std::uint16_t> listen(Acceptor& acceptor, const Endpoint& endpoint);

}  // namespace vitrine
