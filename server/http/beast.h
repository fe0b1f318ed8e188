// SPDX-License-Identifier: Apache-2.0
// Boost.Asio with coroutines, and the parts of Boost.Beast that read requests: heavy, for few
// files.
#pragma once

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/awaitable.hpp>
#include <boost/asio/co_spawn.hpp>
#include <boost/asio/detached.hpp>
#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/post.hpp>
#include <boost/asio/steady_timer.hpp>
#include <boost/asio/strand.hpp>
#include <boost/asio/thread_pool.hpp>
#include <boost/asio/use_awaitable.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/http/buffer_body.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>

#include "server/http/http_header.h"

namespace vitrine {

namespace asio = boost::asio;

using Tcp = asio::ip::tcp;

// Awaits without exceptions: co_await gives a tuple that starts with the error code.
inline constexpr auto kNoThrow = asio::as_tuple(asio::use_awaitable);

}  // namespace vitrine
