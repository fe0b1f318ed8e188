// SPDX-License-Identifier: Apache-2.0
// A real Ceph object gateway, one for all tests of a process: it takes a quarter of a minute to
// start.
#pragma once

#include <string>

#include "server/store/s3_client.h"

namespace vitrine::test {

// "http://127.0.0.1:PORT". Throws where it cannot be started.
const std::string& ceph_gateway();

inline const S3Keys kGatewayKeys{"museum", "the-secret-of-the-museum"};

// Of a bucket that is new and empty: s3://NAME?endpoint=….
std::string new_bucket();

}  // namespace vitrine::test
