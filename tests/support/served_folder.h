// SPDX-License-Identifier: Apache-2.0
// Makes a data folder with published models, for tests of the daemon.
#pragma once

#include <stdexcept>
#include <string>

#include "server/auth/authenticator.h"
#include "server/store/installation.h"
#include "server/store/publish.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"
#include "support/tiny_pmesh.h"

namespace vitrine::test {

inline const TinyPmesh& served_pmesh() {
  static const TinyPmesh pmesh = [] {
    std::string chunk;
    for (int i = 0; chunk.size() < 40'000; ++i)
      chunk += std::to_string(i);
    return tiny_pmesh("a base mesh", chunk);
  }();
  return pmesh;
}

class ServedFolder {
 public:
  ServedFolder() : installation_(open_installation({.folder = folder_.path()}).value()) {}

  const std::filesystem::path& path() const { return folder_.path(); }

  std::string publish(const std::string& title, const TinyPmesh& pmesh = served_pmesh()) {
    const auto id = ::vitrine::server::publish(*installation_.store, *installation_.catalogue,
                                               pmesh.bytes, {.title = title});
    if (!id) throw std::runtime_error(id.error().message);
    return id->id.to_string();
  }

  std::string token(Role role) { return new_token(role).text; }
  NewToken new_token(Role role) { return create_token(*installation_.catalogue, role, "").value(); }

 private:
  TemporaryFolder folder_;
  Installation installation_;
};

inline std::string file_bytes(std::size_t offset, std::size_t length) {
  const auto& bytes = served_pmesh().bytes;
  return {bytes.begin() + static_cast<std::ptrdiff_t>(offset),
          bytes.begin() + static_cast<std::ptrdiff_t>(offset + length)};
}

}  // namespace vitrine::test
