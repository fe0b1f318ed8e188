// SPDX-License-Identifier: Apache-2.0
#include "server/cli/doctor/checks.h"

#include <fmt/core.h>

#include "server/cli/doctor/catalogue_copy.h"
#include "server/store/file_store.h"
#include "server/store/scrub.h"

namespace vitrine::server {
namespace {

constexpr const char* kObjectCheck = "objects";
constexpr const char* kCatalogueCheck = "integrity";

Findings check_catalogue_integrity(const InstallationPlace& place) {
  const auto faults = find_catalogue_faults(place);
  if (!faults)
    return {{Verdict::kFail, kCatalogueCheck, faults.error().message, "restore a backup"}};
  if (faults->empty()) return {{Verdict::kOk, kCatalogueCheck, "the catalogue is intact", ""}};
  Findings findings;
  for (const std::string& fault : *faults)
    findings.push_back({Verdict::kFail, kCatalogueCheck, fault, "restore a backup"});
  return findings;
}

Expected<ScrubReport> scrub_folder(const std::filesystem::path& data) {
  const CatalogueCopy copy(data);
  const auto catalogue = copy.open();
  if (!catalogue) return tl::unexpected(catalogue.error());
  const auto store = FileStore::open(data / "objects");
  if (!store) return tl::unexpected(store.error());
  return scrub(*store, **catalogue);
}

Expected<ScrubReport> scrub_installation(const InstallationPlace& place) {
  if (place.store.empty() && place.catalogue.empty()) return scrub_folder(place.folder);
  const auto installation = open_installation(place);
  if (!installation) return tl::unexpected(installation.error());
  return scrub(*installation->store, *installation->catalogue);
}

Findings check_objects(const InstallationPlace& place) {
  const auto report = scrub_installation(place);
  if (!report)
    return {{Verdict::kFail, kObjectCheck, report.error().message, "solve this and run it again"}};
  if (report->damaged.empty()) {
    return {{Verdict::kOk, kObjectCheck,
             fmt::format("{} objects, {} bytes, all intact", report->objects, report->bytes), ""}};
  }
  Findings findings;
  for (const DamagedFile& damaged : report->damaged) {
    findings.push_back({Verdict::kFail, kObjectCheck, to_text(damaged),
                        "put it back with 'vitrine repair', or publish the model again"});
  }
  return findings;
}

}  // namespace

Findings check_integrity(const InstallationPlace& place) {
  std::error_code unknown;
  if (place.catalogue.empty() && !std::filesystem::exists(place.folder / kCatalogueFile, unknown))
    return {};  // another finding reports this fault
  Findings findings = check_catalogue_integrity(place);
  for (Finding& finding : check_objects(place))
    findings.push_back(std::move(finding));
  return findings;
}

}  // namespace vitrine::server
