// SPDX-License-Identifier: Apache-2.0
// Tests requests for a model whose file takes long to open.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "held_object.h"
#include "server/api/routes.h"
#include "server/store/publish.h"
#include "support/local_server.h"
#include "support/process/http_client.h"
#include "support/tiny_pmesh.h"

namespace vitrine::server {
namespace {

using Clients = std::vector<std::unique_ptr<test::HttpClient>>;

// Sends requests for the path. There are more requests than threads for handlers.
Clients crowd(std::uint16_t port, const std::string& path) {
  Clients clients;
  for (unsigned i = 0; i < 2 + Services::kWaitingThreads + 8; ++i) {
    clients.push_back(std::make_unique<test::HttpClient>(port));
    clients.back()->send("GET " + path + " HTTP/1.1\r\nHost: localhost\r\n\r\n");
  }
  return clients;
}

TEST(ColdModels, RequestsThatWaitForOneModelDoNotDelayRequestsForAnother) {
  const test::TinyPmesh large = test::tiny_pmesh("a base", "a chunk"),
                        other = test::tiny_pmesh("another base", "another chunk");
  const std::string chunk = "/api/v1/chunks/" + to_hex(large.manifest.chunks[0].sha256);
  for (const std::string& part : {std::string("/manifest"), std::string("/file.pmesh"), chunk}) {
    test::LocalServer server(public_routes());
    const auto path_of = [&](const test::TinyPmesh& file) {
      return "/api/v1/models/" +
             publish(server.store(), server.catalogue(), file.bytes, {.title = "A"})
                 ->id.to_string();
    };
    const std::string held = path_of(large), free = path_of(other);
    test::HeldObject object(server.data(), sha256(large.bytes));
    const Clients clients = crowd(server.port(), part == chunk ? chunk : held + part);
    EXPECT_EQ(test::http_get(server.port(), free + "/manifest").status, 200) << part;
    object.release();
    for (const auto& client : clients)
      EXPECT_EQ(client->receive().status, 200) << part;
  }
}

}  // namespace
}  // namespace vitrine::server
