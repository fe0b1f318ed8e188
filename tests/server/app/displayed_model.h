// SPDX-License-Identifier: Apache-2.0
// A fixture with the real daemon and a published model that build_model() has made.
#pragma once

#include <stdexcept>

#include "codec/build/build_model.h"
#include "server/store/installation.h"
#include "server/store/publish.h"
#include "support/process/daemon.h"
#include "support/process/http_client.h"
#include "support/product_names.h"
#include "support/temporary_folder.h"
#include "support/wavy_sheet.h"

namespace vitrine::test {

inline const BuildResult& built_model() {
  static const BuildResult result = [] {
    const std::string text = wavy_sheet(60);  // 6962 triangles
    auto model = build_model({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()}, {},
                             [](std::string_view, double) {});
    if (!model) throw std::runtime_error(model.error().message);
    return std::move(*model);
  }();
  return result;
}

class DisplayedModel {
 public:
  explicit DisplayedModel(const ModelMetadata& metadata = {},
                          const std::vector<std::string>& settings = {})
      : id(publish_in(folder.path(), metadata)),
        api("/api/v1/models/" + id),
        daemon(folder.path(), settings) {}

  std::uint16_t port() const { return daemon.port(); }

  const std::vector<LevelInfo>& levels = built_model().report.manifest.levels;
  const TemporaryFolder folder;
  const std::string id, api;
  Daemon daemon;

 private:
  static std::string publish_in(const std::filesystem::path& data, const ModelMetadata& metadata) {
    Installation installation = open_installation({.folder = data}).value();
    const auto published =
        publish(*installation.store, *installation.catalogue, built_model().file, metadata);
    if (!published) throw std::runtime_error(published.error().message);
    return published->id.to_string();
  }
};

}  // namespace vitrine::test
