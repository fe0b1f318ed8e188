// SPDX-License-Identifier: Apache-2.0
// A real Ceph object gateway. All tests of a process share it, because it takes 15 seconds to
// start.
#pragma once

#include <string>

#include "server/store/s3_client.h"
#include "support/product_names.h"

namespace vitrine::test {

// Returns "http://127.0.0.1:PORT". Throws if the gateway cannot be started.
const std::string& ceph_gateway();

inline const S3Keys kGatewayKeys{"museum", "the-secret-of-the-museum"};

// Creates an empty bucket and returns its address: s3://NAME?endpoint=….
std::string new_bucket();

}  // namespace vitrine::test
