// SPDX-License-Identifier: Apache-2.0
// Defines the completion token for asynchronous calls that return their errors instead of throwing.
#pragma once

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace vitrine::server {

// `co_await call(…, kNoThrow)` returns a tuple that begins with the error code.
inline constexpr auto kNoThrow = boost::asio::as_tuple(boost::asio::use_awaitable);

}  // namespace vitrine::server
