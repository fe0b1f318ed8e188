// SPDX-License-Identifier: Apache-2.0
// An installation with its objects in a real bucket and its catalogue in a real database.
#pragma once

#include <fstream>
#include <string>

#include "server/store/installation.h"
#include "support/process/ceph_gateway.h"
#include "support/process/postgres_server.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"

namespace vitrine::test {

class RemoteInstallation {
 public:
  RemoteInstallation()
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
  // Returns the path of the daemon's configuration file.
  std::string file() const { return (folder_.path() / "vitrine.conf").string(); }

 private:
  TemporaryFolder folder_;
  const InstallationPlace place_;
};

}  // namespace vitrine::test
