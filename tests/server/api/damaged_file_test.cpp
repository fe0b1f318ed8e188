// SPDX-License-Identifier: Apache-2.0
// Tests the responses for a file that is found damaged and then repaired.
#include <gtest/gtest.h>

#include "server/api/routes.h"
#include "server/store/publish.h"
#include "support/damage_object.h"
#include "support/local_server.h"
#include "support/process/http_client.h"
#include "support/tiny_pmesh.h"

namespace vitrine::server {
namespace {

// A cache may have copied the damaged bytes before the server found the damage.
TEST(DamagedFile, CopiesFromThatTimeAreNotConfirmedAfterTheRepair) {
  test::LocalServer server(public_routes());
  const test::TinyPmesh file = test::tiny_pmesh("a base", "a chunk");
  const Sha256 name = sha256(file.bytes);
  const auto published = publish(server.store(), server.catalogue(), file.bytes, {.title = "A"});
  const std::string paths[] = {
      "/api/v1/chunks/" + to_hex(file.manifest.chunks[0].sha256),
      "/api/v1/models/" + published->id.to_string() + "/file.pmesh",
  };
  for (const std::string& path : paths) {
    const auto get = [&](const std::string& tag) {
      return test::http_get(server.port(), path, "If-None-Match: " + tag + "\r\n");
    };
    const test::HttpAnswer first = get("\"other\"");
    ASSERT_EQ(first.status, 200) << path;
    EXPECT_EQ(get(first.field("etag")).status, 304);
    test::damage_object(server.data(), name);
    ASSERT_TRUE(server.scrubber().check_all());
    EXPECT_EQ(get(first.field("etag")).status, 500);
    ASSERT_TRUE(server.store().put(name, file.bytes));
    server.scrubber().check_damaged();
    const test::HttpAnswer repaired = get(first.field("etag"));
    EXPECT_EQ(repaired.status, 200) << path;
    EXPECT_EQ(repaired.body, first.body);
    EXPECT_EQ(get(repaired.field("etag")).status, 304);
  }
}

}  // namespace
}  // namespace vitrine::server
