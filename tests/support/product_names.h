// SPDX-License-Identifier: Apache-2.0
// Lets tests and benchmarks use the product's types without naming the product's namespaces.
#pragma once

namespace vitrine {

namespace acquisition {}
namespace server {}

namespace test {
using namespace acquisition;
using namespace server;
}  // namespace test

namespace bench {
using namespace acquisition;
using namespace server;
}  // namespace bench

}  // namespace vitrine
