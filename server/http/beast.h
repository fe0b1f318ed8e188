// SPDX-License-Identifier: Apache-2.0
// Includes Boost.Asio with coroutines, and the parts of Boost.Beast that parse requests. Include
// this header in few files, because it is slow to compile.
#pragma once

#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/buffer_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>

#include "server/messages/http_header.h"
#include "server/transport/no_throw.h"

namespace vitrine::server {

namespace asio = boost::asio;

using Tcp = asio::ip::tcp;

}  // namespace vitrine::server
