// SPDX-License-Identifier: Apache-2.0
// The completion token of asynchronous calls whose errors are handled in place.
#pragma once

#include <boost/asio/as_tuple.hpp>
#include <boost/asio/use_awaitable.hpp>

namespace vitrine::server {

// `co_await call(…, kNoThrow)` returns a tuple that begins with the error code.
inline constexpr auto kNoThrow = boost::asio::as_tuple(boost::asio::use_awaitable);

}  // namespace vitrine::server
