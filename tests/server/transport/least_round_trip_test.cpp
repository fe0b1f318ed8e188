// SPDX-License-Identifier: Apache-2.0
#include "server/transport/least_round_trip.h"

#include <gtest/gtest.h>

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/local/stream_protocol.hpp>

namespace vitrine::server {
namespace {

namespace asio = boost::asio;
using asio::ip::tcp;

TEST(LeastRoundTrip, IsKnownAfterTheTcpHandshake) {
  asio::io_context context;
  tcp::acceptor acceptor(context, {asio::ip::address_v4::loopback(), 0});
  tcp::socket client(context), server(context);
  client.connect(acceptor.local_endpoint());
  acceptor.accept(server);
  EXPECT_TRUE(least_round_trip(server.native_handle()));
}

TEST(LeastRoundTrip, IsNotKnownForOtherSockets) {
  asio::io_context context;
  asio::local::stream_protocol::socket one(context), other(context);
  asio::local::connect_pair(one, other);
  EXPECT_FALSE(least_round_trip(one.native_handle()));
  EXPECT_FALSE(least_round_trip(-1));
}

}  // namespace
}  // namespace vitrine::server
