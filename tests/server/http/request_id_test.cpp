// SPDX-License-Identifier: Apache-2.0
#include "server/http/request_id.h"

#include <gtest/gtest.h>

namespace vitrine::server {
namespace {

TEST(RequestId, DiffersForEveryRequest) {
  EXPECT_NE(next_request_id(), next_request_id());
}

}  // namespace
}  // namespace vitrine::server
