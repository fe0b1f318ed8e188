// SPDX-License-Identifier: Apache-2.0
// The layout of a data folder: objects/, catalogue.sqlite, and scans/ where there are any.
#pragma once

#include <filesystem>
#include <memory>

#include "server/catalogue/catalogue.h"
#include "server/catalogue/jobs.h"
#include "server/store/object_store.h"

namespace vitrine {

inline constexpr const char* kCatalogueFile = "catalogue.sqlite";  // below the data folder

struct Installation {
  std::unique_ptr<ObjectStore> store;
  std::unique_ptr<Catalogue> catalogue;
  std::unique_ptr<JobCatalogue> jobs;  // in the same file
};

// Whether the folder, or the one that it would be made in, can be written to. Creates nothing.
// Fails (kIo) with the cause.
Expected<void> check_installation(const std::filesystem::path& folder);

// Whether the folder is an installation, or may become one: it exists and nothing else is in it. So
// a mistyped name makes no installation that nobody serves. Fails (kIo) with the next step.
Expected<void> check_data_folder(const std::filesystem::path& folder);

// Creates what is missing. Several processes may open the same folder.
Expected<Installation> open_installation(const std::filesystem::path& folder);

}  // namespace vitrine
