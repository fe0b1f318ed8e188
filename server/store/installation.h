// SPDX-License-Identifier: Apache-2.0
// What an installation is made of: a data folder (objects/, catalogue.sqlite, and scans/ where
// there are any), and in the place of its objects a bucket, of its catalogue a PostgreSQL database.
#pragma once

#include <filesystem>
#include <memory>
#include <string>

#include "server/catalogue/catalogue.h"
#include "server/catalogue/jobs.h"
#include "server/catalogue/sql.h"
#include "server/store/object_store.h"

namespace vitrine {

inline constexpr const char* kCatalogueFile = "catalogue.sqlite";  // below the data folder
inline constexpr const char* kDaemonLock = "daemon.lock";          // likewise

struct InstallationPlace {
  std::filesystem::path folder;
  std::string store = {}, catalogue = {};  // s3://… and postgresql://…; empty: in the folder
  std::string access_key = {}, secret_key = {};  // of the store
};

struct Installation {
  InstallationPlace place;
  std::unique_ptr<ObjectStore> store;
  std::unique_ptr<Catalogue> catalogue;
  std::unique_ptr<JobCatalogue> jobs;       // in the same database
  std::shared_ptr<sql::Database> database;  // in which all of that is
};

// Whether the folder, or the one that it would be made in, can be written to. Creates nothing.
// Fails (kIo) with the cause.
Expected<void> check_installation(const std::filesystem::path& folder);

// The folder is there afterwards. Fails (kIo) with the cause.
Expected<void> make_data_folder(const std::filesystem::path& folder);

// Whether the folder is an installation, or may become one: it exists and nothing else is in it. So
// a mistyped name makes no installation that nobody serves. Fails (kIo) with the next step.
Expected<void> check_data_folder(const std::filesystem::path& folder);

// Whether the place makes sense, before anything is asked of it. Fails with kBadInput.
Expected<void> check_place(const InstallationPlace& place);

// Creates what is missing, but for buckets and databases. Several processes may open the same
// place. Fails with kBadInput where it makes no sense, and with kIo.
Expected<Installation> open_installation(const InstallationPlace& place);

}  // namespace vitrine
