// SPDX-License-Identifier: Apache-2.0
// The header of a request as Boost.Beast has parsed it.
#pragma once

#include <boost/beast/http/fields.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/status.hpp>

namespace vitrine::server {

namespace beast = boost::beast;

using RequestHeader = beast::http::request_header<beast::http::fields>;

}  // namespace vitrine::server
