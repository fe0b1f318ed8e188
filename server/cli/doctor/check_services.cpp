// SPDX-License-Identifier: Apache-2.0
#include "server/cli/doctor/checks.h"

#include <fmt/core.h>

#include "server/store/s3_store.h"

namespace vitrine::server {
namespace {

Finding check_store(const InstallationPlace& place) {
  auto address = S3Address::parse(place.store);
  if (!address) return {Verdict::kFail, "store", address.error().message, "correct the setting"};
  const std::string name = address->url_of("");
  const auto store = S3Store::open({.address = std::move(*address),
                                    .keys = {place.access_key, place.secret_key},
                                    .copies = place.folder,
                                    .lock = {}});
  if (!store)
    return {Verdict::kFail, "store", store.error().message,
            "the server needs it; correct the setting or start it"};
  return {Verdict::kOk, "store", name + " allows write, read, list and remove", ""};
}

Expected<Finding> look_for_files(const Installation& installation) {
  const auto named = installation.catalogue->files();
  if (!named) return tl::unexpected(named.error());
  std::vector<NamedFile> missing;
  for (const NamedFile& file : *named) {
    const auto size = installation.store->size_of(file.file);
    if (!size) return tl::unexpected(size.error());
    if (*size != file.bytes) missing.push_back(file);
  }
  if (missing.empty()) {
    return Finding{Verdict::kOk, "catalogue",
                   fmt::format("{} models, all files present", models_in(*named)), ""};
  }
  return Finding{
      Verdict::kFail, "catalogue",
      fmt::format("the files of {} of {} models are missing, first of {}", models_in(missing),
                  models_in(*named), missing.front().model.to_string()),
      "publish them again, or restore the bucket"};
}

Finding check_catalogue(const InstallationPlace& place) {
  const auto installation = open_installation(place);
  const auto found = installation ? look_for_files(*installation)
                                  : Expected<Finding>(tl::unexpected(installation.error()));
  if (found) return *found;
  return {Verdict::kFail, "catalogue", found.error().message,
          "the server needs it; correct the setting or start it"};
}

}  // namespace

Findings check_services(const InstallationPlace& place) {
  Findings findings;
  if (!place.store.empty()) findings.push_back(check_store(place));
  findings.push_back(check_catalogue(place));
  return findings;
}

}  // namespace vitrine::server
