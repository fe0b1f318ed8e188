// SPDX-License-Identifier: Apache-2.0
// An installation of Vitrine is a data folder with objects/, catalogue.sqlite and, if there are
// scans, scans/. An S3 bucket can replace objects/, and a PostgreSQL database can replace
// catalogue.sqlite.
#pragma once

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "server/catalogue/catalogue.h"
#include "server/catalogue/jobs.h"
#include "server/catalogue/notes.h"
#include "server/catalogue/sql.h"
#include "server/catalogue/visits.h"
#include "server/store/object_store.h"

namespace vitrine::server {

// Names of files in the data folder.
inline constexpr const char* kCatalogueFile = "catalogue.sqlite";
inline constexpr const char* kDaemonLock = "daemon.lock";  // locked by a running daemon

struct InstallationPlace {
  std::filesystem::path folder;
  // URLs s3://… and postgresql://…; if one is empty, the data is in `folder`
  std::string store = {}, catalogue = {};
  std::string access_key = {}, secret_key = {};  // credentials for an s3:// store
};

struct Installation {
  InstallationPlace place;
  std::unique_ptr<ObjectStore> store;
  std::unique_ptr<Catalogue> catalogue;
  // The same catalogue, through connections that only lookups of tokens use. They wait for no other
  // user of the catalogue.
  std::unique_ptr<Catalogue> tokens;
  std::unique_ptr<JobCatalogue> jobs;       // the jobs and scans, in `database`
  std::unique_ptr<NoteCatalogue> notes;     // the notes and tours, in `database`
  std::unique_ptr<VisitCatalogue> visits;   // the counts of visits, in `database`
  std::shared_ptr<sql::Database> database;  // the catalogue's database
};

// Checks that the folder is writable, or, if it does not exist, that it can be created. Creates
// nothing. Fails with kIo.
Expected<void> check_installation(const std::filesystem::path& folder);

// Creates the folder if it is missing. Only its owner can enter the new folder. Fails with kIo.
Expected<void> make_data_folder(const std::filesystem::path& folder);

// Checks that the folder is an installation, or contains only entries that a folder may have before
// an installation is created in it. Without this check, a mistyped name would create an
// installation that no daemon serves. Fails with kIo.
Expected<void> check_data_folder(const std::filesystem::path& folder);

// Checks the form of the addresses without connecting. Fails with kBadInput.
Expected<void> check_place(const InstallationPlace& place);

// Reads the whole catalogue and returns its faults, each in one line; empty if there are none. Uses
// a connection of its own, so others may use the catalogue meanwhile. The catalogue must exist.
// Fails with kIo if it cannot be opened.
Expected<std::vector<std::string>> find_catalogue_faults(const InstallationPlace& place);

// Opens the installation. Creates missing parts, except buckets and databases. Several processes
// may open the same installation. Fails with kBadInput if an address is malformed, and with kIo if
// a part cannot be opened.
Expected<Installation> open_installation(const InstallationPlace& place);

}  // namespace vitrine::server
