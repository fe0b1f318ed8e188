// SPDX-License-Identifier: Apache-2.0
#include "support/process/postgres_server.h"

#include "support/process/backend_process.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"

namespace vitrine::test {
namespace {

BackendProcess& server() {
  static const TemporaryFolder folder;
  static BackendProcess process(
      {VITRINE_SOURCE_DIR "/tests/support/process/postgres.sh", folder.path().string()});
  return process;
}

}  // namespace

std::string new_database() {
  static int made = 0;
  const std::string name = "database" + std::to_string(++made);
  server().ask("create " + name);
  return std::string("postgresql://museum:") + kPostgresPassword + "@127.0.0.1:" + server().line() +
         "/" + name;
}

void stop_postgres() {
  server().ask("stop");
}

void start_postgres() {
  server().ask("start");
}

}  // namespace vitrine::test
