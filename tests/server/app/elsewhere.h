// SPDX-License-Identifier: Apache-2.0
// An installation whose objects are in a real bucket and whose catalogue is in a real database.
#pragma once

#include <fstream>
#include <string>

#include "server/store/installation.h"
#include "support/ceph_gateway.h"
#include "support/postgres_server.h"
#include "support/temporary_folder.h"

namespace vitrine::test {

class Elsewhere {
 public:
  Elsewhere()
      : place_{.folder = folder_.path() / "data",
               .store = new_bucket(),
               .catalogue = new_database(),
               .access_key = kGatewayKeys.access,
               .secret_key = kGatewayKeys.secret} {
    std::filesystem::create_directory(place_.folder);
    std::ofstream(file()) << "data = " << place_.folder.string() << "\nstore = " << place_.store
                          << "\nstore-access-key = " << place_.access_key
                          << "\nstore-secret-key = " << place_.secret_key
                          << "\ncatalogue = " << place_.catalogue << '\n';
  }

  const InstallationPlace& place() const { return place_; }
  std::string file() const { return (folder_.path() / "vitrine.conf").string(); }  // of its daemon

 private:
  TemporaryFolder folder_;
  const InstallationPlace place_;
};

}  // namespace vitrine::test
