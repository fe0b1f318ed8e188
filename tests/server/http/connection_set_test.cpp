// SPDX-License-Identifier: Apache-2.0
#include "server/http/connection_set.h"

#include <gtest/gtest.h>

#include <boost/asio/local/connect_pair.hpp>
#include <boost/asio/local/stream_protocol.hpp>
#include <stdexcept>

namespace vitrine::server {
namespace {

TEST(ConnectionSet, ACheckThatThrowsDoesNotShieldOtherConnections) {
  asio::io_context io;
  asio::local::stream_protocol::socket ours(io), theirs(io), our_other(io), their_other(io);
  asio::local::connect_pair(ours, theirs);
  asio::local::connect_pair(our_other, their_other);
  ConnectionSet set(2, 2, {});
  int asked = 0;
  for (auto* socket : {&ours, &our_other}) {
    const auto connection = std::make_shared<Connection>(ByteStream::Socket(std::move(*socket)));
    ASSERT_EQ(set.add(connection), ConnectionSet::Admission::kAdmitted);
    set.lasts_while(*connection, [&asked]() -> bool {
      ++asked;
      throw std::runtime_error("no memory");
    });
  }
  EXPECT_THROW(set.end_forbidden(), std::runtime_error);
  EXPECT_EQ(asked, 2);
}

}  // namespace
}  // namespace vitrine::server
